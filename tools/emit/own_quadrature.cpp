#include "tools/emit/own_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/quadrature.h"

namespace misfit::tools {

kernels::Correction whole_support_correction(const kernels::PiecewisePolynomial& function, int half) {
  const double end = function.width() / 2.0;
  const kernels::Quadrature rule = kernels::gauss_legendre(2 * half, -end, end);
  Eigen::VectorXd weight = rule.weight;
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    const auto r = std::min(static_cast<Eigen::Index>(std::floor(rule.node[i] + end)), Eigen::Index{function.width() - 1});
    const double centre = static_cast<double>(r) - (function.width() - 1) / 2.0;
    weight[i] *= function(centre - rule.node[i])[r];
  }
  return [node = rule.node, weight](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return ((2 * std::numbers::pi * x * node.transpose()).array().cos().matrix() * weight).cwiseInverse();
  };
}

}  // namespace misfit::tools
