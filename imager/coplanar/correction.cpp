#include "imager/coplanar/correction.h"

#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {

std::vector<double> axis_correction(const kernels::Kernel& kernel, int pixels, int fft_size) {
  const Eigen::VectorXd x = (Eigen::VectorXd::LinSpaced(pixels, 0, pixels - 1).array() - pixels / 2) / fft_size;
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, x);
  return {h.begin(), h.end()};
}

SmoothCorrection::SmoothCorrection(const kernels::Kernel& kernel, double tolerance) {
  const double end = std::min(0.4999, 1.01 * kernel.x0);
  scale = 2 / (end * end);
  constexpr int nodes = 64;
  Eigen::VectorXd x(nodes);
  for (int i = 0; i < nodes; ++i) x[i] = end * std::sqrt((1 + std::cos(pi * (i + 0.5) / nodes)) / 2);
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, x);
  const double size = h.cwiseAbs().maxCoeff();
  int terms = 1;
  for (int k = 0; k < nodes; ++k) {
    double sum = 0;
    for (int i = 0; i < nodes; ++i) sum += h[i] * std::cos(pi * k * (i + 0.5) / nodes);
    coefficient.push_back((k == 0 ? 1.0 : 2.0) / nodes * sum);
    if (std::abs(coefficient.back()) > tolerance * size) terms = k + 1;
  }
  coefficient.resize(static_cast<std::size_t>(terms));
}

}  // namespace misfit::imager
