#include "imager/beams/radial_function.h"

#include <algorithm>
#include <cmath>

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
  const double t = place - cell;
  const double* const v = value_.data() + cell;  // at −1, 0, 1, 2
  return -t * (t - 1) * (t - 2) / 6 * v[0] + (t + 1) * (t - 1) * (t - 2) / 2 * v[1] - (t + 1) * t * (t - 2) / 2 * v[2] +
         (t + 1) * t * (t - 1) / 6 * v[3];
}

void for_each_within(double reach, DirectionCosines axis, const ImageGeometry& geometry, int threads,
                     const std::function<void(std::size_t pixel, double sine)>& visit) {
  const Towards towards(axis);
  const auto width = static_cast<std::size_t>(geometry.width);
  parallel_for(static_cast<std::size_t>(geometry.height), threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const DirectionCosines at = geometry.at(static_cast<int>(row), static_cast<int>(column));
      const double sine = sine_between(Towards(at), towards);  // not a number beyond the horizon
      if (sine <= reach) visit(row * width + column, sine);
    }
  });
}

}  // namespace misfit::imager
