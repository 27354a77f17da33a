#include "imager/weighting/uv_taper.h"

#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {

UvTaper taper_of_beam(const Beam& beam) {
  const double factor = pi * pi / (4 * std::log(2));
  return {factor * beam.major_rad * beam.major_rad, factor * beam.minor_rad * beam.minor_rad, beam.position_angle_rad};
}

UvTaper taper_of_radii(const UvRadii& radii) {
  return {std::log(2) / (radii.along_lambda * radii.along_lambda), std::log(2) / (radii.across_lambda * radii.across_lambda),
          radii.position_angle_rad};
}

double taper_exponent_m2(const UvTaper& taper, double u_m, double v_m) {
  const double sine = std::sin(taper.position_angle_rad), cosine = std::cos(taper.position_angle_rad);
  const double along = u_m * sine + v_m * cosine, across = v_m * sine - u_m * cosine;
  return taper.along * along * along + taper.across * across * across;
}

}  // namespace misfit::imager
