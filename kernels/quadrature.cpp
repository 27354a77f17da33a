#include "kernels/quadrature.h"

#include <cmath>
#include <numbers>

namespace misfit::kernels {

Quadrature gauss_legendre(int points, double from, double to) {
  Quadrature rule{Eigen::VectorXd(points), Eigen::VectorXd(points)};
  const double half = (to - from) / 2;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5));
    double slope = 0;
    for (int newton = 0; newton < 8; ++newton) {
      double p = 1;
      double previous = 0;
      for (int k = 1; k <= points; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * previous) / k;
        previous = p;
        p = next;
      }
      slope = points * (x * p - previous) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    rule.node[points - 1 - i] = from + half * (1 + x);
    rule.weight[points - 1 - i] = half * 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace misfit::kernels
