#include <algorithm>
#include <cmath>

#include "kernels/map_error.h"
#include "tools/hosts/image_divisor_internal.h"

namespace misfit::hosts {
namespace {

constexpr double least = 1e-15, most = 1e15;

double divisor(double h) {
  const double reciprocal = 1 / h;
  return std::isnan(reciprocal) ? most : std::copysign(std::clamp(std::abs(reciprocal), least, most), reciprocal);
}

}  // namespace

Eigen::VectorXd image_divisor(const kernels::TapFunction& taps, int length, int steps_per_cell) {
  constexpr Eigen::Index at_once = 256;  // pixels, times thousands of positions where the taps are a table's
  const Eigen::Index centre = length / 2;
  Eigen::VectorXd from_centre(centre + 1);  // h is even
  for (Eigen::Index begin = 0; begin <= centre; begin += at_once) {
    const Eigen::Index count = std::min(at_once, centre + 1 - begin);
    const auto first = static_cast<double>(begin);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(count, first, first + static_cast<double>(count - 1)) / length;
    from_centre.segment(begin, count) = kernels::optimal_correction(taps, x, steps_per_cell).unaryExpr(&divisor);
  }
  Eigen::VectorXd all(length);
  for (Eigen::Index i = 0; i < length; ++i) all[i] = from_centre[std::abs(i - centre)];
  return all;
}

}  // namespace misfit::hosts
