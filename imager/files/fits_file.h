#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_writer.h"

namespace misfit::imager {

/// Version of the CFITSIO that is linked: "4.2.0".
std::string cfitsio_version();

/// A column of a binary table.
struct FitsColumn {
  std::string name;
  std::string unit;
  bool whole = false;          ///< 32-bit integers; otherwise 32-bit floating-point numbers
  std::vector<double> values;  ///< [row]
};

/// A FITS file opened with CFITSIO, at its primary image unless a table was opened; it is closed when this goes out of scope.
/// Axes count from 0, pixels along them from 1. Errors are std::runtime_errors that name the path that the user gave: "cannot
/// read a.fits: …".
class FitsFile {
 public:
  /// `doing`: "read" or "write".
  FitsFile(std::string doing, std::string path);
  FitsFile(const FitsFile&) = delete;
  FitsFile& operator=(const FitsFile&) = delete;
  ~FitsFile();

  /// Make or open the file of this name, taken literally: nothing in it is expanded.
  void create(const std::string& name);
  void open(const std::string& name);
  void close();
  /// Gives up what is not yet written of a file: CFITSIO otherwise fills a file that is closed early up to its full size.
  void abandon();
  [[noreturn]] void fail(const std::string& reason) const;

  void write_number(const std::string& key, double value, const std::string& comment = "");
  /// An empty text stands for an unknown value, and is left out.
  void write_text(const std::string& key, const std::string& value, const std::string& comment = "");
  void write_integer(const std::string& key, int value, const std::string& comment = "");
  void write_flag(const std::string& key, bool value, const std::string& comment = "");
  void write_history(const std::string& line);
  /// Leaves room for so many more cards, so that those written after pixels do not move them.
  void reserve_cards(int count);
  /// The value of a card; none where there is none, or it has no value. Throws where it is no finite number, and where several
  /// cards have this key and different values, of which readers take one or another.
  std::optional<double> number(const std::string& key) const;
  double needed_number(const std::string& key) const;
  /// The text of a card, with ? for control characters; empty where there is none. Throws where several cards have this key and
  /// different values.
  std::string text(const std::string& key) const;

  void create_image(std::vector<long> size, PixelFormat format);
  /// Writes pixels from `first` on, the first axis fastest.
  void write_pixels(std::vector<long> first, const std::vector<double>& pixels);
  /// The length of each axis.
  std::vector<long> size() const;
  /// Reads as many pixels as `pixels` holds. Blanks become NaN.
  void read_pixels(std::vector<long> first, std::vector<double>& pixels) const;

  /// Appends a binary table, whose columns have one length, and goes there.
  void append_table(const std::string& name, const std::vector<FitsColumn>& columns);
  /// Goes to the table of this name, if there is one.
  bool open_table(const std::string& name);
  /// Goes to the primary image.
  void open_image();
  /// The column of a table. Throws where it has more than `most` rows.
  std::vector<double> column(const std::string& name, std::size_t most) const;

 private:
  struct Handle;

  void check(int status) const;

  std::string doing_;
  std::string path_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace misfit::imager
