#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace misfit::ms_io {

/// Thrown where there is no file, or it ends early, or it is not what casacore would read: casacore will say so itself.
struct Malformed {
  std::string path;
};

/// The bytes of a file of casacore, or some gathered from it, at any place.
class StoredBytes {
 public:
  /// Throws Malformed where there is no such file, std::runtime_error where it is no regular one.
  explicit StoredBytes(const std::string& path);
  StoredBytes(std::string path, std::string gathered);

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Throws Malformed where they end before `at` + `count`, std::runtime_error where they cannot be read.
  void read(std::uint64_t at, char* to, std::size_t count);
  std::string read(std::uint64_t at, std::size_t count);
  /// Throws std::runtime_error that names the file.
  [[noreturn]] void fail(const std::string& tells, const std::string& expected) const;

 private:
  void fetch(std::uint64_t at, char* to, std::size_t count);

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::string window_;  ///< the bytes read last, or all that were gathered
  std::uint64_t window_at_ = 0;
};

enum class ByteOrder { big, little };

/// Reads what casacore's AipsIO writes, from a place on: numbers, texts, and objects that begin with their length, their type
/// and its version. Every function throws as StoredBytes::read() does, and std::runtime_error where a number states more than
/// is left.
class ObjectReader {
 public:
  explicit ObjectReader(StoredBytes& bytes, ByteOrder order = ByteOrder::big, std::uint64_t at = 0)
      : bytes_(bytes), order_(order), at_(at) {}

  const StoredBytes& bytes() const { return bytes_; }
  std::uint64_t at() const { return at_; }
  std::uint64_t left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }
  void skip(std::uint64_t count);

  std::uint64_t number(std::size_t size);
  std::int64_t integer(std::size_t size);
  /// A number of things that take at least `bytes_each`.
  std::uint64_t count(std::size_t size, const std::string& things, std::size_t bytes_each);
  std::string text();
  /// Skips a text of any length.
  void skip_text() { skip(count(4, "letters", 1)); }

  /// Reads the word that stands before all objects of a file.
  void magic();
  /// Begins an object of any type, and returns its type; or of the type given, and returns its version, or throws Malformed.
  std::string object();
  std::uint64_t object(const std::string& type);
  /// Ends the object that began at a place: throws Malformed where it has another length than it states.
  void end(std::uint64_t begin);
  /// An IPosition.
  std::vector<std::int64_t> lengths();
  /// A Block of numbers.
  std::vector<std::uint64_t> block(const std::string& things, std::size_t size = 4);

 private:
  StoredBytes& bytes_;
  ByteOrder order_;
  std::uint64_t at_;
};

/// The product of lengths, 0 of none; throws std::runtime_error that names `things` where one is negative, or where the product
/// of the lengths that are not 0 is beyond what casacore counts.
double product(const std::vector<std::int64_t>& lengths, const StoredBytes& of, const std::string& things);

/// A number as people read it, of any size.
std::string shown(double number);

}  // namespace misfit::ms_io
