#include "imager/geometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace misfit::imager {

DirectionCosines direction_cosines(const SkyDirection& direction, const SkyDirection& centre) {
  const double east = direction.ra_rad - centre.ra_rad;
  const double n = std::sin(direction.dec_rad) * std::sin(centre.dec_rad) +
                   std::cos(direction.dec_rad) * std::cos(centre.dec_rad) * std::cos(east);
  if (n <= 0)
    throw std::invalid_argument("direction at right ascension " + std::to_string(direction.ra_rad) + " rad, declination " +
                                std::to_string(direction.dec_rad) + " rad is not within 90 degrees of the phase centre");
  return {std::cos(direction.dec_rad) * std::sin(east),
          std::sin(direction.dec_rad) * std::cos(centre.dec_rad) -
              std::cos(direction.dec_rad) * std::sin(centre.dec_rad) * std::cos(east)};
}

double largest_drop(const ImageGeometry& geometry) {
  double largest = 0;
  for (const DirectionCosines& at : geometry.corners()) largest = std::max(largest, beyond_horizon(at) ? 1 : -n_minus_1(at));
  return largest;
}

bool crosses_horizon(const ImageGeometry& geometry) {
  const auto corners = geometry.corners();
  return std::any_of(corners.begin(), corners.end(), beyond_horizon);
}

}  // namespace misfit::imager
