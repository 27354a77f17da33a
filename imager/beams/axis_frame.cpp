#include "imager/beams/axis_frame.h"

namespace misfit::imager {

AxisFrame::AxisFrame(DirectionCosines axis, double phase_centre_dec_rad) : axis_(axis) {
  constexpr double at_a_pole = 1e-9;
  Towards pole;
  pole.m = std::cos(phase_centre_dec_rad);
  pole.n = std::sin(phase_centre_dec_rad);
  const double along = pole.along(axis_);  // what is left of the pole without it points north at the axis
  north_.l = pole.l - along * axis_.l;
  north_.m = pole.m - along * axis_.m;
  north_.n = pole.n - along * axis_.n;
  if (std::sqrt(north_.along(north_)) < at_a_pole) {
    north_ = {};
    north_.m = 1;
  }
  east_.l = north_.m * axis_.n - north_.n * axis_.m;
  east_.m = north_.n * axis_.l - north_.l * axis_.n;
  east_.n = north_.l * axis_.m - north_.m * axis_.l;
}

}  // namespace misfit::imager
