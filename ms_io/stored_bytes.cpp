#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "ms_io/stored_bytes_internal.h"

namespace misfit::ms_io {

namespace fs = std::filesystem;

StoredBytes::StoredBytes(const std::string& path) : path_(path) {
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  if (!fs::exists(status)) throw Malformed{path_};
  if (!fs::is_regular_file(status)) throw std::runtime_error("cannot read " + path + ": it is no regular file");
  errno = 0;
  file_.rdbuf()->pubsetbuf(nullptr, 0);
  file_.open(path, std::ios::binary);
  if (!file_) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
  size_ = fs::file_size(path);
}

StoredBytes::StoredBytes(std::string path, std::string gathered)
    : path_(std::move(path)), size_(gathered.size()), window_(std::move(gathered)) {}

void StoredBytes::fail(const std::string& tells, const std::string& expected) const {
  throw std::runtime_error("cannot read " + path_ + ": it states " + tells + ", expected " + expected);
}

void StoredBytes::fetch(std::uint64_t at, char* to, std::size_t count) {
  errno = 0;
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(to, static_cast<std::streamsize>(count));
  if (file_.bad()) throw std::runtime_error("cannot read " + path_ + ": " + std::strerror(errno));
  if (!file_) throw Malformed{path_};
}

void StoredBytes::read(std::uint64_t at, char* to, std::size_t count) {
  constexpr std::size_t most = 4096;
  if (at > size_ || count > size_ - at) throw Malformed{path_};
  if (at < window_at_ || at + count > window_at_ + window_.size()) {
    if (count > most) return fetch(at, to, count);
    std::string window(std::min<std::uint64_t>(most, size_ - at), '\0');
    fetch(at, window.data(), window.size());
    window_ = std::move(window);
    window_at_ = at;
  }
  std::copy_n(window_.data() + (at - window_at_), count, to);
}

std::string StoredBytes::read(std::uint64_t at, std::size_t count) {
  if (at > size_ || count > size_ - at) throw Malformed{path_};
  std::string bytes(count, '\0');
  read(at, bytes.data(), count);
  return bytes;
}

void ObjectReader::skip(std::uint64_t count) {
  if (count > left()) throw Malformed{bytes_.path()};
  at_ += count;
}

std::uint64_t ObjectReader::number(std::size_t size) {
  unsigned char bytes[8];
  bytes_.read(at_, reinterpret_cast<char*>(bytes), size);
  at_ += size;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[order_ == ByteOrder::big ? i : size - 1 - i];
  return value;
}

std::int64_t ObjectReader::integer(std::size_t size) {
  const std::uint64_t value = number(size);
  return size == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}

std::uint64_t ObjectReader::count(std::size_t size, const std::string& things, std::size_t bytes_each) {
  const std::uint64_t counted = number(size);
  if (counted > left() / bytes_each) bytes_.fail(std::to_string(counted) + " " + things, "no more than it holds");
  return counted;
}

std::string ObjectReader::text() {
  constexpr std::uint64_t longest = 1 << 16;
  const std::uint64_t length = count(4, "letters", 1);
  if (length > longest) bytes_.fail("a name of " + std::to_string(length) + " letters", std::to_string(longest) + " or fewer");
  std::string text = bytes_.read(at_, length);
  at_ += length;
  return text;
}

void ObjectReader::magic() {
  if (number(4) != 0xbebebebe) throw Malformed{bytes_.path()};
}

std::string ObjectReader::object() {
  number(4);
  return text();
}

std::uint64_t ObjectReader::object(const std::string& type) {
  if (object() != type) throw Malformed{bytes_.path()};
  return number(4);
}

void ObjectReader::end(std::uint64_t begin) {
  if (ObjectReader(bytes_, order_, begin).number(4) != at_ - begin) throw Malformed{bytes_.path()};
}

std::vector<std::int64_t> ObjectReader::lengths() {
  const std::uint64_t begin = at_;
  const std::size_t size = object("IPosition") == 1 ? 4 : 8;
  std::vector<std::int64_t> all(count(4, "axes", size));
  for (std::int64_t& length : all) length = integer(size);
  end(begin);
  return all;
}

std::vector<std::uint64_t> ObjectReader::block(const std::string& things, std::size_t size) {
  const std::uint64_t begin = at_;
  object("Block");
  std::vector<std::uint64_t> all(count(4, things, size));
  for (std::uint64_t& value : all) value = number(size);
  end(begin);
  return all;
}

double product(const std::vector<std::int64_t>& lengths, const StoredBytes& of, const std::string& things) {
  constexpr double most = 1e18;
  double all = lengths.empty() ? 0 : 1, steps = 1;
  for (const std::int64_t length : lengths) {
    if (length < 0) of.fail(things + " of length " + std::to_string(length), "0 or more");
    all *= static_cast<double>(length);
    steps *= static_cast<double>(std::max<std::int64_t>(1, length));
  }
  if (steps > most)
    of.fail(things + " of " + std::to_string(lengths.size()) + " axes, with " + shown(steps) + " values", "fewer");
  return all;
}

std::string shown(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

}  // namespace misfit::ms_io
