#include "imager/beams/radial_function.h"

#include <algorithm>
#include <cmath>

#include "imager/beams/axis_frame.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {

double first_sine_at(double level, double step, const RadialFunction& function) {
  double before = 0, after = 0;
  while (after < 1 && function(after) > level) {
    before = after;
    after = std::min(1.0, after + step);
  }
  if (function(after) > level) return 1;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = (before + after) / 2;
    (function(middle) > level ? before : after) = middle;
  }
  return after;
}

RadialTable::RadialTable(double reach, int threads, const RadialFunction& function) : reach_(reach), value_(points + 3) {
  parallel_for(value_.size(), threads, [&](std::size_t i) {
    value_[i] = function(std::abs(static_cast<double>(i) - 1) * step());  // even about the axis
  });
}

RadialTables::RadialTables(double reach, int threads, std::size_t count, const Functions& functions, double detail)
    : count_(count),
      points_(static_cast<int>(std::ceil(RadialTable::points * detail))),
      step_(reach / points_),
      value_((static_cast<std::size_t>(points_) + 3) * count) {
  parallel_for(value_.size() / count, threads,
               [&](std::size_t i) { functions(std::abs(static_cast<double>(i) - 1) * step_, value_.data() + i * count_); });
}

namespace {

template <typename Visit>
void for_each_direction(double reach, const AxisFrame& frame, const ImageGeometry& geometry, int threads, const Visit& visit) {
  const auto width = static_cast<std::size_t>(geometry.width);
  parallel_for(static_cast<std::size_t>(geometry.height), threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const DirectionCosines at = geometry.at(static_cast<int>(row), static_cast<int>(column));
      const double sine = frame.sine(at);  // not a number beyond the horizon
      if (sine <= reach) visit(row * width + column, sine, at);
    }
  });
}

}  // namespace

void for_each_within(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                     const std::function<void(std::size_t pixel, double sine)>& visit) {
  for_each_direction(reach, AxisFrame(axis, geometry.phase_centre.dec_rad), geometry, threads,
                     [&](std::size_t pixel, double sine, DirectionCosines) { visit(pixel, sine); });
}

void for_each_off_axis(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                       const std::function<void(std::size_t pixel, double sine, double angle_rad)>& visit) {
  const AxisFrame frame(axis, geometry.phase_centre.dec_rad);
  for_each_direction(reach, frame, geometry, threads,
                     [&](std::size_t pixel, double sine, DirectionCosines at) { visit(pixel, sine, frame.angle_rad(at)); });
}

}  // namespace misfit::imager
