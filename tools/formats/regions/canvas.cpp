#include "tools/formats/regions/canvas.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"
#include "ms_io/celestial_frames.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

constexpr double farthest_pixels = 1e9;  // up to which a double tells millionths of a pixel apart

}  // namespace

bool has_right_ascensions(const std::string& frame) {
  return frame != "GALACTIC" && frame != "ECLIPTIC" && frame != "SUPERGAL";
}

Point Canvas::at(const Place& place, double latitude_rad) const {
  const imager::SkyDirection& centre = geometry_.phase_centre;
  const imager::SkyDirection there = ms_io::in_frame({place.x.value, latitude_rad, place.frame}, centre.frame);
  imager::DirectionCosines seen;
  try {
    seen = direction_cosines(there, centre);
  } catch (const std::invalid_argument&) {
    refuse(place.text, "a place within 90 degrees of the image's phase centre: beyond is its horizon");
  }
  return {geometry_.centre_column() - (seen.l - geometry_.centre.l) / geometry_.cell_rad,
          geometry_.centre_row() + (seen.m - geometry_.centre.m) / geometry_.cell_height_rad()};
}

Point Canvas::point(const Place& place) const {
  if (place.x.pixels != place.y.pixels) refuse(place.text, "both in pixels or both on the sky");
  if (!place.x.pixels && std::abs(place.x.value) > 2 * imager::pi) refuse(place.text, "a longitude of -360 to 360 degrees");
  if (!place.x.pixels && std::abs(place.y.value) > imager::pi / 2) refuse(place.text, "a latitude of -90 to 90 degrees");
  const Point point = place.x.pixels ? Point{place.x.value, place.y.value} : at(place, place.y.value);
  if (!(std::max(std::abs(point.column), std::abs(point.row)) <= farthest_pixels))
    refuse(place.text, "a place at most 1e9 pixels away");
  return point;
}

double Canvas::north_rad(const Place& place) const {
  if (place.x.pixels) return 0;
  constexpr double step_rad = 1e-5;  // its square, and the rounding of places over it, turn no border by a millionth of a pixel
  const Point south = at(place, place.y.value - step_rad), north = at(place, place.y.value + step_rad);
  return std::atan2(south.column - north.column, north.row - south.row);
}

double Canvas::pixels(const Quantity& length, std::string_view text) const {
  const double pixels = length.pixels ? length.value : length.value / geometry_.cell_rad;
  if (!(pixels > 0)) refuse(text, "a length above 0");
  if (!(pixels <= farthest_pixels)) refuse(text, "a length of at most 1e9 pixels");
  return pixels;
}

}  // namespace misfit::tools::regions
