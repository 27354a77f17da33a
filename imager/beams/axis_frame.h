#pragma once

#include <cmath>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// Directions about an axis, by true angles, as dishes that point along the axis have them.
class AxisFrame {
 public:
  /// The frame of an axis as a phase centre of this declination sees it. About a pole, north is where the image has it.
  AxisFrame(DirectionCosines axis, double phase_centre_dec_rad);

  /// The axis, as seen from the phase centre.
  DirectionCosines axis() const { return {axis_.l, axis_.m}; }
  /// sin θ of the angle θ between a direction and the axis; 2 where the direction is farther away than 90°, and NaN where it
  /// lies beyond the horizon of the phase centre.
  double sine(DirectionCosines at) const { return sine(Towards(at)); }
  /// The position angle about the axis, from the north there through the east, of a direction within 90° that is not the axis
  /// itself.
  double angle_rad(DirectionCosines at) const {
    const Towards d(at);
    return std::atan2(d.along(east_), d.along(north_));
  }

 private:
  /// A vector to the east, to the north, and to the phase centre.
  struct Towards {
    double l = 0, m = 0, n = 0;
    Towards() = default;
    Towards(double east, double north, double centre) : l(east), m(north), n(centre) {}
    explicit Towards(DirectionCosines at) : l(at.l), m(at.m), n(1 + n_minus_1(at)) {}
    double along(const Towards& other) const { return l * other.l + m * other.m + n * other.n; }
    /// The part of this vector that is perpendicular to another of length 1.
    Towards across(const Towards& other) const {
      const double part = along(other);
      return {l - part * other.l, m - part * other.m, n - part * other.n};
    }
  };

  /// From the chord, which keeps small angles.
  double sine(const Towards& at) const {
    const double l = at.l - axis_.l, m = at.m - axis_.m, n = at.n - axis_.n, chord2 = l * l + m * m + n * n;
    return chord2 > 2 ? 2 : std::sqrt(chord2 * (1 - chord2 / 4));
  }

  Towards axis_, north_, east_;
};

}  // namespace misfit::imager
