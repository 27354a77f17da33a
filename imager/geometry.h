#pragma once

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

/// n − 1 for a direction, without cancellation near the centre; NaN beyond the horizon.
inline double n_minus_1(DirectionCosines at) {
  const double r2 = at.l * at.l + at.m * at.m;
  return -r2 / (1 + std::sqrt(1 - r2));
}

/// The pixels of an image. Column c lies at l = centre.l − (c − width/2)·cell, so that east is on the left; row r lies at
/// m = centre.m + (r − height/2)·cell, so that north is up in a FITS viewer. The divisions are integer divisions.
struct ImageGeometry {
  int width = 0;
  int height = 0;
  double cell_rad = 0;
  SkyDirection phase_centre;
  DirectionCosines centre = {};  ///< of the pixel in the middle, from the phase centre

  int centre_column() const { return width / 2; }
  int centre_row() const { return height / 2; }
  double l(int column) const { return centre.l - (column - centre_column()) * cell_rad; }
  double m(int row) const { return centre.m + (row - centre_row()) * cell_rad; }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

}  // namespace misfit::imager
