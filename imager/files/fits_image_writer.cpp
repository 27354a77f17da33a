#include "imager/files/fits_image_writer.h"

#include <filesystem>
#include <limits>
#include <system_error>

#include "imager/files/fits_beams.h"
#include "imager/files/fits_header.h"
#include "imager/files/written_planes.h"
#include "kernels/whole_file.h"

namespace misfit::imager {
namespace {

/// The cards of add_cards() for which there is room; more move the pixels.
constexpr int later_cards = 24;

/// The most cards that the history takes; each holds 72 characters of it.
int history_cards(const ImageHeader& header) {
  std::size_t cards = 0;
  for (const std::string& line : header.history) cards += line.size() / 70 + 1;
  return static_cast<int>(cards);
}

class FitsImageWriter : public ImageWriter {
 public:
  FitsImageWriter(const ImageHeader& header, const std::string& path, PixelFormat format)
      : target_(kernels::writable_target(path)),
        temporary_(kernels::temporary_beside(target_)),
        planes_(header),
        history_(header.history),
        file_("write", path) {
    stokes_axis(header.stokes);
    try {
      file_.create(temporary_);
      file_.create_image(
          {header.geometry.width, header.geometry.height, header.spectral.channels, static_cast<long>(header.stokes.size())},
          format);
      write_header(file_, header);
      file_.reserve_cards(fits_beam_cards + later_cards + history_cards(header));
    } catch (...) {
      remove_unfinished();
      throw;
    }
  }

  FitsImageWriter(const FitsImageWriter&) = delete;
  FitsImageWriter& operator=(const FitsImageWriter&) = delete;
  ~FitsImageWriter() override {
    if (!finished_) remove_unfinished();
  }

  void write(const PlaneIndex& at, const Image& image, const std::optional<Beam>& beam) override {
    planes_.add(at, image, beam);
    write_pixels(at, image);
  }

  void add_cards(const std::vector<HeaderCard>& cards) override { write_cards(file_, cards); }

  void finish() override {
    write_missing();
    write_beams(file_, planes_.beams());
    for (const std::string& line : history_) file_.write_history(line);
    write_beam_table(file_, planes_.beams());
    file_.close();
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) file_.fail(error.message());
    finished_ = true;
  }

 private:
  void write_pixels(const PlaneIndex& at, const Image& image) {
    file_.write_pixels({1, 1, at.channel + 1, at.stokes + 1}, image.pixel);
  }

  void write_missing() {
    const std::vector<PlaneIndex> missing = planes_.missing();
    if (missing.empty()) return;
    const Image blank = planes_.blank();
    for (const PlaneIndex& at : missing) write_pixels(at, blank);
  }

  void remove_unfinished() {
    file_.abandon();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  WrittenPlanes planes_;
  std::vector<std::string> history_;
  FitsFile file_;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<ImageWriter> create_fits_image(const ImageHeader& header, const std::string& path, PixelFormat format) {
  return std::make_unique<FitsImageWriter>(header, path, format);
}

}  // namespace misfit::imager
