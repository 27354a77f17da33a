#include "tools/emit/realised_error.h"

#include <algorithm>
#include <cmath>

#include "kernels/quadrature.h"

namespace misfit::tools {

RealisedError realised_error(const HostRule& rule, double x0) {
  const kernels::Misfit axis = kernels::judge(rule.taps, x0, {rule.steps_per_cell, rule.correction});
  double mean = axis.mean;  // the mean of 1 − hc: with the optimal correction, ℓ itself
  if (rule.correction) {
    const kernels::Quadrature x = kernels::gauss_legendre(48, 0, x0);
    const Eigen::VectorXd taper = kernels::image_taper(rule.taps, x.node, rule.steps_per_cell);
    mean = 1 - x.weight.dot(rule.correction(x.node).cwiseProduct(taper)) / x0;
  }
  const double square = 2 * axis.mean + 2 * mean * mean + axis.mean * axis.mean - 4 * axis.mean * mean;
  const double worst = std::sqrt(axis.worst);
  return {std::sqrt(std::max(square, 0.0)), 2 * worst + worst * worst};
}

double rounding(const kernels::PiecewisePolynomial& function, double x0, int bits) {
  const double gain = kernels::noise_gain(function, x0);
  return std::ldexp(gain * gain, -bits);
}

RealisedError with_rounding(const RealisedError& error, double rounding) {
  constexpr double worst = 6;  // standard deviations
  return {std::hypot(error.rms, rounding), error.largest + worst * rounding};
}

}  // namespace misfit::tools
