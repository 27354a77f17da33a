#pragma once

#include <string>

#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "imager/files/sky_grid.h"

namespace misfit::tools {

/// How the pixels of an image in a file lie beside those of an image of the run, by what both state of the sky.
class GridBeside {
 public:
  /// `what` names the file: "mask a.fits". The file must say where it lies on the sky. Where both move along with their fields
  /// (Observation::moving_at), each counts from where its own field was. Throws std::runtime_error where the file moves along
  /// and the image stands still.
  GridBeside(const imager::ImageReader& file, const std::string& what, const imager::ImageHeader& image);

  /// The file's grid; where the file moves along with its field, about the image's phase centre and not where the file says.
  const imager::SkyGrid& grid() const { return grid_; }
  /// Where the pixels of the image lie among those of the file, in whatever frame.
  const imager::GridMap& map() const { return map_; }
  /// What the user should know where the image moves along and the file does not say so; else empty.
  const std::string& remark() const { return remark_; }

 private:
  imager::SkyGrid grid_;
  imager::GridMap map_;
  std::string remark_;
};

/// The offset of an image's pixels on a grid: whole pixels to the right and up from the place of the same numbers, to within
/// `most` pixels.
struct GridOffset {
  bool any = false;  ///< whether the grid has a place for any pixel
  bool all = true;   ///< whether it has one for every pixel
  double right = 0, up = 0;
  double most = 0;  ///< pixels
};
GridOffset offset_between(const imager::GridMap& map, const imager::ImageGeometry& image);

/// Throws std::runtime_error that begins with `what`, which names the file, unless its pixels are those of the image.
void require_same_pixels(const imager::ImageReader& file, const std::string& what, const imager::ImageHeader& image);

/// "1arcsec × 1arcsec, SIN about 12h 30m 00.000s +12° 23′ 28.00″ (FK5) at pixel 33, 33", counted from 1.
std::string described(const imager::SkyGrid& grid);

}  // namespace misfit::tools
