#include "imager/data/geometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"

namespace misfit::imager {

DirectionCosines direction_cosines(const SkyDirection& direction, const SkyDirection& centre) {
  const double east = direction.ra_rad - centre.ra_rad;
  const double n = std::sin(direction.dec_rad) * std::sin(centre.dec_rad) +
                   std::cos(direction.dec_rad) * std::cos(centre.dec_rad) * std::cos(east);
  constexpr double degree = pi / 180;
  if (n <= 0)
    throw std::invalid_argument("direction at right ascension " + std::to_string(direction.ra_rad / degree) +
                                " degrees, declination " + std::to_string(direction.dec_rad / degree) +
                                " degrees is not within 90 degrees of the phase centre");
  return {std::cos(direction.dec_rad) * std::sin(east),
          std::sin(direction.dec_rad) * std::cos(centre.dec_rad) -
              std::cos(direction.dec_rad) * std::sin(centre.dec_rad) * std::cos(east)};
}

SkyDirection sky_direction(DirectionCosines at, const SkyDirection& centre) {
  if (beyond_horizon(at))
    throw std::invalid_argument("direction cosines " + std::to_string(at.l) + ", " + std::to_string(at.m) +
                                " lie beyond the horizon; expected l² + m² of at most 1");
  const double n = 1 + n_minus_1(at);
  const double sine = std::sin(centre.dec_rad), cosine = std::cos(centre.dec_rad);
  // Cartesian: towards the centre's hour circle on the equator, east, and north. Arc tangents keep their precision everywhere.
  const double x = n * cosine - at.m * sine, y = at.l, z = n * sine + at.m * cosine;
  const double ra_rad = std::fmod(centre.ra_rad + std::atan2(y, x), 2 * pi);
  return {ra_rad < 0 ? ra_rad + 2 * pi : ra_rad, std::atan2(z, std::hypot(x, y)), centre.frame};
}

double largest_drop(const ImageGeometry& geometry) {
  double largest = 0;
  for (const DirectionCosines& at : geometry.corners()) largest = std::max(largest, drop(at));
  return largest;
}

bool crosses_horizon(const ImageGeometry& geometry) {
  const auto corners = geometry.corners();
  return std::any_of(corners.begin(), corners.end(), beyond_horizon);
}

}  // namespace misfit::imager
