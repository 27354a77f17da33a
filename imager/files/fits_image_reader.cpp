#include "imager/files/fits_image_reader.h"

#include <stdexcept>

#include "imager/files/fits_beams.h"
#include "imager/files/fits_celestial.h"
#include "imager/files/fits_header.h"

namespace misfit::imager {
namespace {

class FitsImageReader : public ImageReader {
 public:
  FitsImageReader(const std::string& path, Grids grids) : file_("read", path) {
    file_.open(path);
    planes_ = find_planes(file_);
    header_ = read_header(file_, planes_);
    grid_ = read_sky_grid(file_, planes_.steps);
    header_.geometry = geometry(grids);
    header_.observation.phase_centre = header_.geometry.phase_centre;
    find_beams();
  }

  const ImageHeader& header() const override { return header_; }
  std::optional<Beam> beam(const PlaneIndex& at) const override {
    if (!no_beams_because_.empty()) throw std::runtime_error(no_beams_because_);
    return beams_.at(at);
  }

  const std::optional<SkyGrid>& grid() const override { return grid_; }

  Image read_rows(const PlaneIndex& at, int first, int count) const override {
    Image image(header_.geometry.width, count);
    std::vector<long> pixel = first_pixel(planes_, at);
    pixel[1] = first + 1;
    file_.read_pixels(pixel, image.pixel);
    return image;
  }

 private:
  /// Reads beams, if possible: masks and models need none, and may have kept the beams of an image that they were cut from.
  void find_beams() {
    try {
      beams_ = read_beams(file_, header_.spectral.channels, static_cast<int>(header_.stokes.size()));
    } catch (const std::runtime_error& error) {
      no_beams_because_ = error.what();
      file_.open_image();
    }
  }

  ImageGeometry geometry(Grids wanted) const {
    const std::vector<long> size = file_.size();
    try {
      return geometry_on(grid_, wanted, {static_cast<int>(size[0]), static_cast<int>(size[1]), 0, {}});
    } catch (const std::invalid_argument& error) {
      file_.fail(error.what());
    }
  }

  FitsFile file_;
  FitsPlanes planes_;
  std::optional<SkyGrid> grid_;
  ImageHeader header_;
  PlaneBeams beams_;
  std::string no_beams_because_;  ///< why they cannot be read
};

}  // namespace

std::unique_ptr<ImageReader> open_fits_image(const std::string& path, Grids grids) {
  return std::make_unique<FitsImageReader>(path, grids);
}

}  // namespace misfit::imager
