#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/fits_image.h"

namespace misfit::imager {

/// The primary image of a FITS file, as CFITSIO has it, closed when it goes out of scope. Axes count from 0, pixels along them
/// from 1. Errors are std::runtime_errors that name the path that the user gave: "cannot read a.fits: …".
class FitsFile {
 public:
  /// `doing`: "read" or "write".
  FitsFile(std::string doing, std::string path);
  FitsFile(const FitsFile&) = delete;
  FitsFile& operator=(const FitsFile&) = delete;
  ~FitsFile();

  /// The file of this name, as it stands: nothing in it is expanded.
  void create(const std::string& name);
  void open(const std::string& name);
  void close();
  [[noreturn]] void fail(const std::string& reason) const;

  void write_number(const std::string& key, double value, const std::string& comment = "");
  /// An empty text stands for what is not known, and is left out.
  void write_text(const std::string& key, const std::string& value, const std::string& comment = "");
  void write_history(const std::string& line);
  std::optional<double> number(const std::string& key) const;
  double needed_number(const std::string& key) const;
  /// Empty where there is none.
  std::string text(const std::string& key) const;

  void create_image(std::vector<long> size, PixelFormat format);
  /// From the pixel `first` on, the first axis fastest.
  void write_pixels(std::vector<long> first, const std::vector<double>& pixels);
  /// The length of each axis.
  std::vector<long> size() const;
  /// As many as `pixels` holds. Blanks are NaN.
  void read_pixels(std::vector<long> first, std::vector<double>& pixels) const;

 private:
  struct Handle;

  void check(int status) const;
  bool read_key(const std::string& key, int type, void* value) const;

  std::string doing_;
  std::string path_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace misfit::imager
