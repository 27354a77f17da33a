#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace misfit::imager {

/// A direction on the celestial sphere.
struct SkyDirection {
  double ra_rad = 0;
  double dec_rad = 0;
  std::string frame = "FK5";  ///< FITS RADESYS: "ICRS", "FK5" (J2000) or "FK4" (B1950)
};

/// Direction cosines relative to a phase centre: l to the east, m to the north.
struct DirectionCosines {
  double l = 0;
  double m = 0;
};

/// The direction cosines of `direction` as seen from `centre` (SIN projection; Thompson, Moran & Swenson 2017, Interferometry
/// and Synthesis in Radio Astronomy). Throws std::invalid_argument when it lies more than 90° away.
DirectionCosines direction_cosines(const SkyDirection& direction, const SkyDirection& centre);

/// The direction whose cosines, as seen from `centre`, are `at`, exactly and near the poles too; 0 ≤ ra_rad ≤ 2π, in the frame
/// of `centre`. Throws std::invalid_argument beyond the horizon.
SkyDirection sky_direction(DirectionCosines at, const SkyDirection& centre);

/// n − 1 for a direction, without cancellation near the centre; NaN beyond the horizon.
inline double n_minus_1(DirectionCosines at) {
  const double r2 = at.l * at.l + at.m * at.m;
  return -r2 / (1 + std::sqrt(1 - r2));
}

/// True if a direction lies beyond the horizon, l² + m² > 1.
inline bool beyond_horizon(DirectionCosines at) {
  return std::isnan(n_minus_1(at));
}

/// The pixels of an image. Column c lies at l = centre.l − (c − width/2)·cell, so that east is on the left; row r lies at
/// m = centre.m + (r − height/2)·cell·aspect, so that north is up in a FITS viewer. The divisions are integer divisions.
struct ImageGeometry {
  int width = 0;
  int height = 0;
  double cell_rad = 0;  ///< a pixel's width
  SkyDirection phase_centre;
  DirectionCosines centre = {};  ///< of the pixel in the middle, from the phase centre
  double pixel_aspect = 1;       ///< a pixel's height over its width; functions that make beams expect 1

  double cell_height_rad() const { return cell_rad * pixel_aspect; }
  int centre_column() const { return width / 2; }
  int centre_row() const { return height / 2; }
  double l(int column) const { return centre.l - (column - centre_column()) * cell_rad; }
  double m(int row) const { return centre.m + (row - centre_row()) * cell_height_rad(); }
  DirectionCosines at(int row, int column) const { return {l(column), m(row)}; }
  std::array<DirectionCosines, 4> corners() const {
    return {at(0, 0), at(0, width - 1), at(height - 1, 0), at(height - 1, width - 1)};
  }
  bool off_phase_centre() const { return centre.l != 0 || centre.m != 0; }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// 1 − n, where n counts as 0 beyond the horizon.
inline double drop(DirectionCosines at) {
  return beyond_horizon(at) ? 1 : -n_minus_1(at);
}

/// The largest drop of any pixel. Over a rectangle it is in a corner.
double largest_drop(const ImageGeometry& geometry);

/// True if any pixel lies beyond the horizon: if one does, a corner does.
bool crosses_horizon(const ImageGeometry& geometry);

}  // namespace misfit::imager
