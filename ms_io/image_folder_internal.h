#pragma once

#include <filesystem>
#include <string>

namespace misfit::ms_io {

/// The folder of an image that is made beside its place, and put there when it is complete; until then it is removed again.
class ImageFolder {
 public:
  /// The folder of the image called `path`; links are followed. Throws std::runtime_error that names the path where anything
  /// else than a casacore image lies, or where the unfinished folder's name holds anything else than the remains of an
  /// unfinished casacore image.
  explicit ImageFolder(const std::string& path);
  ImageFolder(const ImageFolder&) = delete;
  ImageFolder& operator=(const ImageFolder&) = delete;
  ~ImageFolder();

  /// The folder where it is made.
  std::string name() const { return unfinished_.string(); }
  /// Puts it in its place; a casacore image that is there gives way. Throws as the constructor does.
  void put_in_place();

 private:
  std::filesystem::path old() const;
  [[noreturn]] void fail(const std::string& reason) const;
  void require_image_or_nothing() const;
  void forget_open_tables() const;
  void remove_left(const std::filesystem::path& left) const;

  std::string path_;
  std::filesystem::path target_;
  std::filesystem::path unfinished_;
};

}  // namespace misfit::ms_io
