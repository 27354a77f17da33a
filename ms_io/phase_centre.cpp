#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <algorithm>
#include <cmath>

#include "ms_io/celestial_frame_internal.h"
#include "ms_io/phase_centre_internal.h"

namespace misfit::ms_io {
namespace {

using Vector = imager::UvwAxes::Vector;

/// Converts a unit vector from one frame to another, at a time.
Vector converted(const Vector& direction, const std::string& from, const std::string& to, const casacore::MeasFrame& when) {
  if (from == to) return direction;
  const casacore::MDirection there(casacore::MVDirection(direction[0], direction[1], direction[2]), direction_type(from));
  const casacore::MDirection::Ref reference(direction_type(to), when);
  const casacore::MVDirection here = casacore::MDirection::Convert(there, reference)().getValue();
  return {here(0), here(1), here(2)};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector unit(const Vector& a) {
  const double length = std::hypot(a[0], a[1], a[2]);
  return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace

double separation_rad(const imager::SkyDirection& a, const imager::SkyDirection& b) {
  const Vector one = imager::uvw_axes(a).w, other = converted(imager::uvw_axes(b).w, b.frame, a.frame, {});
  const double chord = std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
  return 2 * std::asin(std::min(1.0, chord / 2));
}

imager::PhaseShift phase_shift(const FieldCentre& from, const imager::SkyDirection& to) {
  imager::UvwAxes axes = imager::uvw_axes(to);
  if (from.direction.frame != to.frame) {
    const casacore::MeasFrame when(from.observed);
    const auto north_by = [&](double tangent) {
      const Vector &v = axes.v, &w = axes.w;
      const Vector direction = unit({w[0] + tangent * v[0], w[1] + tangent * v[1], w[2] + tangent * v[2]});
      return converted(direction, to.frame, from.direction.frame, when);
    };
    const Vector here = north_by(0), there = north_by(1e-3);  // near, for B1950 holds aberration, which bends long ways
    axes.w = here;
    axes.u = unit(cross(there, here));
    axes.v = cross(axes.w, axes.u);
  }
  return {imager::uvw_axes(from.direction), axes};
}

}  // namespace misfit::ms_io
