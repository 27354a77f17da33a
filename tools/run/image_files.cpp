#include "tools/run/image_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "imager/files/fits_image_writer.h"
#include "ms_io/casa_image.h"

namespace misfit::tools {
namespace {

class SeveralWriters : public imager::ImageWriter {
 public:
  void add(std::unique_ptr<imager::ImageWriter> writer) { writers_.push_back(std::move(writer)); }

  void write(const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam) override {
    for (const auto& writer : writers_) writer->write(at, image, beam);
  }
  void mask_like(const imager::ImageReader& other) override {
    for (const auto& writer : writers_) writer->mask_like(other);
  }
  void add_cards(const std::vector<imager::HeaderCard>& cards) override {
    for (const auto& writer : writers_) writer->add_cards(cards);
  }
  void finish() override {
    for (const auto& writer : writers_) writer->finish();
  }

 private:
  std::vector<std::unique_ptr<imager::ImageWriter>> writers_;
};

}  // namespace

std::mutex& image_files_mutex() {
  static std::mutex mutex;
  return mutex;
}

const std::vector<std::string>& image_formats() {
  static const std::vector<std::string> names{"fits", "casa", "both"};
  return names;
}

imager::PixelFormat pixel_format(double accuracy) {
  return accuracy != 0 && accuracy < 1e-7 ? imager::PixelFormat::float64 : imager::PixelFormat::float32;
}

std::vector<std::string> image_paths(const std::string& name, const std::string& outformat) {
  std::vector<std::string> paths;
  if (outformat != "casa") paths.push_back(name + ".fits");
  if (outformat != "fits") paths.push_back(name);
  return paths;
}

namespace {

/// When a file, or one in a folder, was last changed.
std::optional<std::filesystem::file_time_type> last_change(const std::string& path) {
  std::error_code absent;
  std::filesystem::file_time_type last = std::filesystem::last_write_time(path, absent);
  if (absent) return std::nullopt;
  for (const auto& entry : std::filesystem::directory_iterator(path, absent))
    if (const auto changed = entry.last_write_time(absent); !absent) last = std::max(last, changed);
  return last;
}

}  // namespace

std::optional<std::string> newest_image(const std::string& name) {
  std::optional<std::string> newest;
  std::filesystem::file_time_type changed;
  for (const std::string& path : image_paths(name, "both")) {
    const auto at = last_change(path);
    if (!at || (newest && *at <= changed)) continue;
    newest = path;
    changed = *at;
  }
  return newest;
}

bool is_own_image(const std::string& path) {
  if (!path.ends_with(".fits")) return ms_io::is_own_casa_image(path);
  std::ifstream file(path, std::ios::binary);
  std::string header(16 * 2880, '\0');  // ORIGIN stands before the history
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  return header.find("ORIGIN  = 'misfit") != std::string::npos;
}

void check_image_paths(const std::string& name, const std::string& outformat, const std::string& option) {
  std::error_code absent;
  for (const std::string& path : image_paths(name, outformat)) {
    if (!std::filesystem::exists(path, absent)) continue;
    const bool fits = path.ends_with(".fits");
    if (fits ? !std::filesystem::is_regular_file(path, absent) : !ms_io::is_casa_image(path))
      throw std::runtime_error("cannot write " + path + ": it is there already and no " +
                               (fits ? "regular file" : "casacore image") + "; expected another " + option);
  }
}

std::unique_ptr<imager::ImageWriter> open_image_files(const std::string& name, const imager::ImageHeader& header,
                                                      imager::PixelFormat format, const std::string& outformat) {
  auto files = std::make_unique<SeveralWriters>();
  if (outformat != "casa") files->add(imager::create_fits_image(header, name + ".fits", format));
  if (outformat != "fits") files->add(ms_io::create_casa_image(header, name, format));
  return files;
}

}  // namespace misfit::tools
