#include "imager/beams/radial_function.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "imager/beams/cubic_weights.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// A direction as a vector towards it: east, north, and to the phase centre.
struct Towards {
  double l, m, n;
  explicit Towards(DirectionCosines at) : l(at.l), m(at.m), n(1 + n_minus_1(at)) {}
};

/// sin θ of the angle between two; more than 1 where they are farther apart than 90°. From the chord, which keeps small ones.
double sine_between(const Towards& a, const Towards& b) {
  const double chord2 = (a.l - b.l) * (a.l - b.l) + (a.m - b.m) * (a.m - b.m) + (a.n - b.n) * (a.n - b.n);
  return chord2 > 2 ? 2 : std::sqrt(chord2 * (1 - chord2 / 4));
}

}  // namespace

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

double RadialTable::operator()(double sine) const {
  const double place = sine / step();
  const int cell = std::min(static_cast<int>(place), points - 1);
  const std::array<double, 4> weight = cubic_weights(place - cell);
  const double* const v = value_.data() + cell;  // at −1, 0, 1, 2
  return weight[0] * v[0] + weight[1] * v[1] + weight[2] * v[2] + weight[3] * v[3];
}

namespace {

template <typename Visit>
void for_each_direction(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads, const Visit& visit) {
  const Towards towards(axis);
  const auto width = static_cast<std::size_t>(geometry.width);
  parallel_for(static_cast<std::size_t>(geometry.height), threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const Towards at(geometry.at(static_cast<int>(row), static_cast<int>(column)));
      const double sine = sine_between(at, towards);  // not a number beyond the horizon
      if (sine <= reach) visit(row * width + column, sine, at);
    }
  });
}

}  // namespace

void for_each_within(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                     const std::function<void(std::size_t pixel, double sine)>& visit) {
  for_each_direction(reach, axis, geometry, threads,
                     [&](std::size_t pixel, double sine, const Towards&) { visit(pixel, sine); });
}

void for_each_off_axis(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                       const std::function<void(std::size_t pixel, double sine, double angle_rad)>& visit) {
  const Towards a(axis);
  const double dec = geometry.phase_centre.dec_rad, pole_m = std::cos(dec), pole_n = std::sin(dec);
  const double along = pole_m * a.m + pole_n * a.n;  // the pole's part along the axis: what is left of it points north there
  double north_l = -along * a.l, north_m = pole_m - along * a.m, north_n = pole_n - along * a.n;
  if (std::hypot(north_l, north_m, north_n) < 1e-9) north_l = 0, north_m = 1, north_n = 0;  // at a pole: as the image has it
  const double east_l = north_m * a.n - north_n * a.m, east_m = north_n * a.l - north_l * a.n,
               east_n = north_l * a.m - north_m * a.l;
  for_each_direction(reach, axis, geometry, threads, [&](std::size_t pixel, double sine, const Towards& d) {
    visit(pixel, sine, std::atan2(d.l * east_l + d.m * east_m + d.n * east_n, d.l * north_l + d.m * north_m + d.n * north_n));
  });
}

}  // namespace misfit::imager
