#include "imager/beams/axis_frame.h"

namespace misfit::imager {

AxisFrame::AxisFrame(DirectionCosines axis, double phase_centre_dec_rad) : axis_(axis) {
  constexpr double at_a_pole = 1e-9;
  Towards pole;
  pole.m = std::cos(phase_centre_dec_rad);
  pole.n = std::sin(phase_centre_dec_rad);
  north_ = pole.across(axis_);
  if (north_.along(north_) < at_a_pole * at_a_pole) {
    pole = {};
    pole.m = 1;
    north_ = pole.across(axis_);
  }
  const double length = std::sqrt(north_.along(north_));
  north_ = {north_.l / length, north_.m / length, north_.n / length};
  east_.l = north_.m * axis_.n - north_.n * axis_.m;
  east_.m = north_.n * axis_.l - north_.l * axis_.n;
  east_.n = north_.l * axis_.m - north_.m * axis_.l;
}

}  // namespace misfit::imager
