#include "imager/fits_image_reader.h"

#include "imager/fits_beams.h"
#include "imager/fits_header.h"

namespace misfit::imager {
namespace {

class FitsImageReader : public ImageReader {
 public:
  explicit FitsImageReader(const std::string& path) : file_("read", path) {
    file_.open(path);
    planes_ = find_planes(file_);
    header_ = read_header(file_, planes_);
    beams_ = read_beams(file_, header_.spectral.channels, static_cast<int>(header_.stokes.size()));
  }

  const ImageHeader& header() const override { return header_; }
  std::optional<Beam> beam(const PlaneIndex& at) const override { return beams_.at(at); }

  Image read(const PlaneIndex& at) const override {
    Image image(header_.geometry.width, header_.geometry.height);
    file_.read_pixels(first_pixel(planes_, at), image.pixel);
    return image;
  }

 private:
  FitsFile file_;
  FitsPlanes planes_;
  ImageHeader header_;
  PlaneBeams beams_;
};

}  // namespace

std::unique_ptr<ImageReader> open_fits_image(const std::string& path) {
  return std::make_unique<FitsImageReader>(path);
}

}  // namespace misfit::imager
