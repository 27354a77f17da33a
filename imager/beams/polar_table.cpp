#include "imager/beams/polar_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "imager/beams/cubic_weights.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr int angles = PolarTable::angles;
constexpr double angle_step = 2 * pi / angles;

int turned(int angle) {
  return ((angle % angles) + angles) % angles;
}

}  // namespace

PolarTable::PolarTable(double reach, int threads, const PolarFunction& function)
    : reach_(reach), value_((std::size_t{radii} + 2) * angles) {
  parallel_for(std::size_t{radii} + 2, threads, [&](std::size_t radius) {
    for (int a = 0; a < angles; ++a)
      value_[radius * angles + static_cast<std::size_t>(a)] =
          function(std::min(1.0, static_cast<double>(radius) * reach / radii), a * angle_step);
  });
}

double PolarTable::at(int radius, int angle) const {
  const int across = radius < 0 ? angle + angles / 2 : angle;
  return value_[static_cast<std::size_t>(std::abs(radius)) * angles + static_cast<std::size_t>(turned(across))];
}

double PolarTable::operator()(double sine, double angle_rad) const {
  const double r = sine / reach_ * radii, a = angle_rad / angle_step;
  const int radius = std::min(static_cast<int>(r), radii - 1), angle = static_cast<int>(std::floor(a));
  const std::array<double, 4> of_radius = cubic_weights(r - radius), of_angle = cubic_weights(a - angle);
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k)
      sum += of_radius[static_cast<std::size_t>(i)] * of_angle[static_cast<std::size_t>(k)] * at(radius + i - 1, angle + k - 1);
  return sum;
}

void PolarTable::add_turned(const PolarTable& other, double turn_rad, double by) {
  if (value_.empty()) {
    reach_ = other.reach_;
    value_.resize(other.value_.size());
  }
  const double turn = turn_rad / angle_step;
  const int whole = static_cast<int>(std::floor(turn));
  const std::array<double, 4> weight = cubic_weights(turn - whole);
  for (std::size_t radius = 0; radius < value_.size() / angles; ++radius) {
    const double* const from = other.value_.data() + radius * angles;
    double* const to = value_.data() + radius * angles;
    for (int k = 0; k < 4; ++k)
      for (int a = 0; a < angles; ++a) to[a] += by * weight[static_cast<std::size_t>(k)] * from[turned(a - whole - (k - 1))];
  }
}

LobeEdge::LobeEdge(double level, double step, double farthest, const PolarFunction& function) {
  for (int a = 0; a < angles; ++a) {
    double before = 0, after = 0;
    while (after < farthest && function(after, a * angle_step) > level) {
      before = after;
      after = std::min(farthest, after + step);
    }
    if (!(function(after, a * angle_step) > level))
      for (int halvings = 0; halvings < 40; ++halvings) {
        const double middle = (before + after) / 2;
        (function(middle, a * angle_step) > level ? before : after) = middle;
      }
    sine_.push_back(after);
  }
}

double LobeEdge::farthest() const {
  return *std::max_element(sine_.begin(), sine_.end());
}

bool LobeEdge::holds(double sine, double angle_rad) const {
  const double a = angle_rad / angle_step;
  const int angle = static_cast<int>(std::floor(a));
  const double part = a - angle;
  return sine <= (1 - part) * sine_[static_cast<std::size_t>(turned(angle))] +
                     part * sine_[static_cast<std::size_t>(turned(angle + 1))];
}

}  // namespace misfit::imager
