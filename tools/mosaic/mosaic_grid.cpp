#include "tools/mosaic/mosaic_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/data/phase_shift.h"
#include "imager/mosaic/band_limited_image.h"
#include "ms_io/celestial_frames.h"
#include "tools/base/numbers.h"
#include "tools/formats/grid_offset.h"

namespace misfit::tools {
namespace {

using imager::DirectionCosines;
using imager::ImageGeometry;
using imager::SkyDirection;

constexpr int largest_side = 65536;

/// The frame of the first image if it is FK5 or FK4, else ICRS.
std::string common_frame(const std::vector<Pointing>& pointings) {
  const std::string& frame = pointings.front().image->grid().reference.frame;
  return frame == "FK5" || frame == "FK4" ? frame : "ICRS";
}

/// The direction of the mean of the pointings' unit vectors.
SkyDirection middle(const std::vector<Pointing>& pointings) {
  const std::string frame = common_frame(pointings);
  double x = 0, y = 0, z = 0;
  for (const Pointing& pointing : pointings) {
    const imager::UvwAxes::Vector at = imager::uvw_axes(ms_io::in_frame(pointing.image->grid().reference, frame)).w;
    x += at[0];
    y += at[1];
    z += at[2];
  }
  const double ra_rad = std::atan2(y, x);
  return {ra_rad < 0 ? ra_rad + 2 * M_PI : ra_rad, std::atan2(z, std::hypot(x, y)), frame};
}

DirectionCosines reference_on(const PointingImage& image, const SkyDirection& centre) {
  try {
    return imager::direction_cosines(ms_io::in_frame(image.grid().reference, centre.frame), centre);
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(image.path() + " lies more than 90 degrees from the middle of the mosaic, " + sexagesimal(centre) +
                             "; expected images of one hemisphere");
  }
}

double smallest_cell_rad(const std::vector<Pointing>& pointings) {
  double cell = 1;
  for (const Pointing& pointing : pointings)
    cell = std::min({cell, pointing.image->grid().column_step_rad(), pointing.image->grid().row_step_rad()});
  return cell;
}

/// The farthest that pixels lie from a grid's reference.
double farthest_rad(const imager::SkyGrid& grid) {
  const auto far = [](double reference, int size) { return std::max(std::abs(reference), std::abs(size - 1 - reference)); };
  return std::hypot(far(grid.reference_pixel.column, grid.width) * grid.column_step_rad(),
                    far(grid.reference_pixel.row, grid.height) * grid.row_step_rad());
}

/// How far from the phase centre a mosaic reaches, as direction cosines.
struct Reach {
  double l = 0;
  double m = 0;
};

/// A reach no smaller than the images'.
Reach reach_of_images(const std::vector<Pointing>& pointings, const SkyDirection& centre) {
  constexpr double more = 1.2;  // than a plane of projection says
  double farthest = 0;
  for (const Pointing& pointing : pointings) {
    const DirectionCosines at = reference_on(*pointing.image, centre);
    farthest = std::max(farthest, std::hypot(at.l, at.m) + more * farthest_rad(pointing.image->grid()));
  }
  farthest = std::min(farthest, 1.0);
  return {farthest, farthest};
}

/// Extends the reach to pixels of `header` where a beam is at the limit or above, and its image known, as far as sizes tell.
void add_reach(const Pointing& pointing, int channel, const imager::ImageHeader& header, double limit, int threads,
               Reach& reach) {
  constexpr int margin = imager::BandLimitedImage::margin;
  const GridBeside beside(pointing.image->reader(), "image " + pointing.image->path(), header);
  const imager::Image beam = pointing.beam->on(header, channel, threads);
  for (int r = 0; r < beam.height; ++r)
    for (int c = 0; c < beam.width; ++c) {
      if (!(beam.at(r, c) >= limit)) continue;
      const imager::PixelPlace at = beside.map()(r, c);
      if (!(at.column >= margin && at.column < beside.grid().width - margin && at.row >= margin &&
            at.row < beside.grid().height - margin))
        continue;
      reach.l = std::max(reach.l, std::abs(header.geometry.l(c)));
      reach.m = std::max(reach.m, std::abs(header.geometry.m(r)));
    }
}

/// The reach of beams within `outer`, to a pixel of an image `side` wide; for a cube, at its two ends.
Reach reach_of_beams(const std::vector<Pointing>& pointings, imager::ImageHeader header, const Reach& outer, int side,
                     double limit, int threads) {
  const int last = header.spectral.channels - 1;
  ImageGeometry& geometry = header.geometry;
  geometry.width = geometry.height = side + 4;
  geometry.pixel_aspect = outer.m / outer.l;
  geometry.cell_rad = std::max(2 * outer.l / side, geometry.cell_rad);
  Reach reach;
  for (const Pointing& pointing : pointings)
    for (const int channel : last > 0 ? std::vector{0, last} : std::vector{0})
      add_reach(pointing, channel, header, limit, threads, reach);
  if (reach.l == 0 && reach.m == 0)
    throw std::runtime_error("no beam of the images is " + significant(limit, 3) +
                             " or more where its image has pixels; expected a lower --pblimit, or larger images");
  return {std::min(outer.l, reach.l + geometry.cell_rad), std::min(outer.m, reach.m + geometry.cell_height_rad())};
}

int even_side(double reach, double cell_rad) {
  constexpr double rounding = 1e-6;  // pixels
  const double half = std::ceil(reach / cell_rad - rounding);
  if (2 * half > largest_side)
    throw std::runtime_error("the mosaic would be " + significant(2 * half, 6) + " pixels wide or high; expected " +
                             std::to_string(largest_side) + " at most: give a larger --cell, or --imsize");
  return 2 * static_cast<int>(half);
}

}  // namespace

imager::ImageHeader mosaic_header(const MosaicOptions& o, const std::vector<Pointing>& pointings, int threads) {
  imager::ImageHeader header = pointings.front().image->header();
  header.geometry = {0, 0, o.cell_rad().value_or(smallest_cell_rad(pointings)), o.centre() ? *o.centre() : middle(pointings)};
  ImageGeometry& geometry = header.geometry;
  header.observation.phase_centre = geometry.phase_centre;
  for (const Pointing& pointing : pointings) reference_on(*pointing.image, geometry.phase_centre);
  if (!o.imsize.empty()) {
    geometry.width = o.imsize.front();
    geometry.height = o.imsize.back();
    return header;
  }
  Reach reach = reach_of_images(pointings, geometry.phase_centre);
  for (const int side : {250, 1000}) reach = reach_of_beams(pointings, header, reach, side, o.pblimit, threads);
  geometry.width = even_side(reach.l, geometry.cell_rad);
  geometry.height = even_side(reach.m, geometry.cell_rad);
  return header;
}

double north_turn_rad(const PointingImage& image, const ImageGeometry& mosaic) {
  constexpr double step = 1e-4;
  const SkyDirection &reference = image.grid().reference, &centre = mosaic.phase_centre;
  const SkyDirection north = imager::sky_direction({0, step}, reference);
  const DirectionCosines from = reference_on(image, centre);
  const DirectionCosines to = imager::direction_cosines(ms_io::in_frame(north, centre.frame), centre);
  return std::atan2(to.l - from.l, to.m - from.m);
}

}  // namespace misfit::tools
