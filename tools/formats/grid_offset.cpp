#include "tools/formats/grid_offset.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "ms_io/celestial_frames.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

using imager::ImageGeometry;
using imager::SkyGrid;

/// The turn from the frame of the image to another. Frames are turns of each other, except that the terms of aberration in FK4
/// shift directions by up to 0.35″. A turn about the middle of the image leaves errors of 1.7e-6 of the distance from it, or
/// 0.014 pixels where the image is 16384 wide.
imager::FrameRotation rotation_to(const std::string& frame, const ImageGeometry& image) {
  if (frame == image.phase_centre.frame) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const imager::SkyDirection middle =
      imager::beyond_horizon(image.centre) ? image.phase_centre : imager::sky_direction(image.centre, image.phase_centre);
  const imager::SkyDirection north = imager::sky_direction({0, 1e-3}, middle);
  return imager::rotation_between({middle, north}, {ms_io::in_frame(middle, frame), ms_io::in_frame(north, frame)});
}

SkyGrid grid_beside(const imager::ImageReader& file, const std::string& what, const imager::ImageHeader& image) {
  SkyGrid grid = file.grid().value();
  const std::string& moving_at = file.header().observation.moving_at;
  if (moving_at.empty()) return grid;
  if (image.observation.moving_at.empty())
    throw std::runtime_error(what + " moves along with its field (TRACKFLD is " + moving_at +
                             "), expected one that stands still, as this image does; without TRACKFLD in its header it lies "
                             "where the field was then");
  grid.reference = image.geometry.phase_centre;
  return grid;
}

GridOffset offset_at(const imager::GridMap& map, const std::vector<int>& rows, const std::vector<int>& columns) {
  GridOffset offset;
  for (const int row : rows)
    for (const int column : columns) {
      const imager::PixelPlace place = map(row, column);
      if (!std::isfinite(place.column) || !std::isfinite(place.row)) {
        offset.all = false;
        continue;
      }
      const double right = place.column - column, up = place.row - row;
      if (!offset.any) offset = {true, offset.all, std::round(right), std::round(up), 0};
      offset.most = std::max({offset.most, std::abs(right - offset.right), std::abs(up - offset.up)});
    }
  return offset;
}

}  // namespace

GridBeside::GridBeside(const imager::ImageReader& file, const std::string& what, const imager::ImageHeader& image)
    : grid_(grid_beside(file, what, image)), map_(image.geometry, grid_, rotation_to(grid_.reference.frame, image.geometry)) {
  if (!image.observation.moving_at.empty() && file.header().observation.moving_at.empty())
    remark_ =
        "the " + what +
        " does not say that it moves along with its field (TRACKFLD), as this image does: it is taken to lie where the sky "
        "was about the field at " +
        image.observation.moving_at;
}

/// Looks at the edges, where projections differ most, unless they lie beyond the horizon.
GridOffset offset_between(const imager::GridMap& map, const ImageGeometry& image) {
  const GridOffset edges =
      offset_at(map, {0, image.centre_row(), image.height - 1}, {0, image.centre_column(), image.width - 1});
  if (edges.all) return edges;
  std::vector<int> rows(static_cast<std::size_t>(image.height)), columns(static_cast<std::size_t>(image.width));
  std::iota(rows.begin(), rows.end(), 0);
  std::iota(columns.begin(), columns.end(), 0);
  return offset_at(map, rows, columns);
}

std::string described(const SkyGrid& grid) {
  const auto degrees = [](double angle_rad) { return angle_rad * 180 / M_PI; };
  const double angle = degrees(grid.position_angle_rad());
  const imager::SkyDirection& reference = grid.reference;
  const std::string place = reference.frame == "GALACTIC" ? significant(degrees(reference.ra_rad), 9) + "° " +
                                                                significant(degrees(reference.dec_rad), 9) + "°"
                                                          : sexagesimal(reference);
  std::string text = significant(3600 * degrees(grid.column_step_rad()), 6) + "arcsec × " +
                     significant(3600 * degrees(grid.row_step_rad()), 6) + "arcsec, " +
                     imager::projection_name(grid.projection) + " about " + place + " (" + reference.frame + ") at pixel " +
                     significant(grid.reference_pixel.column + 1, 9) + ", " + significant(grid.reference_pixel.row + 1, 9);
  if (std::abs(angle) > 1e-9) text += ", turned by " + significant(angle, 6) + " degrees";
  if (grid.is_mirrored()) text += ", mirrored";
  if (grid.slant != std::array<double, 2>{}) text += ", slanted";
  return text;
}

void require_same_pixels(const imager::ImageReader& file, const std::string& what, const imager::ImageHeader& image) {
  const ImageGeometry &own = image.geometry, &has = file.header().geometry;
  const auto size = [](const ImageGeometry& g) {
    return std::to_string(g.width) + " × " + std::to_string(g.height) + " pixels";
  };
  if (has.width != own.width || has.height != own.height)
    throw std::runtime_error(what + " has " + size(has) + ", expected " + size(own));
  const GridBeside beside(file, what, image);
  const GridOffset offset = offset_between(beside.map(), own);
  if (offset.any && offset.right == 0 && offset.up == 0 && offset.most < imager::same_place_pixels) return;
  const std::string distance =
      offset.any ? ", " + significant(std::hypot(offset.right, offset.up) + offset.most, 2) + " pixels away" : "";
  throw std::runtime_error(what + " has other pixels, " + described(beside.grid()) + ", expected the image's, " +
                           described(imager::grid_of(own)) + distance + "; regrid it first, as with CASA's imregrid");
}

}  // namespace misfit::tools
