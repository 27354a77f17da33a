#include "kernels/kernel.h"

#include <algorithm>

namespace misfit::kernels {

Kernel make_kernel(const std::string& name, double x0, const TapFunction& taps) {
  // Powers of t amplify rounding with their degree; 16 is where that outgrows what a term can still add.
  constexpr int highest_degree = 16;
  const double target = 1.005 * judge(taps, x0).mean;
  const auto stored = [&](int degree) {
    const PiecewisePolynomial polynomial = fit_polynomial(taps, degree);
    return Kernel{name, x0, polynomial, judge(polynomial, x0)};
  };
  int degree = std::max(0, static_cast<int>(taps(0).size()) - 2);  // W − 1 … W + 1 is what most kernels need
  Kernel best = stored(degree);
  if (best.misfit.mean <= target) {
    while (degree > 0) {
      const Kernel lower = stored(--degree);
      if (lower.misfit.mean > target) break;
      best = lower;
    }
    return best;
  }
  while (best.misfit.mean > target && degree < highest_degree) {
    const Kernel higher = stored(++degree);
    if (higher.misfit.mean < best.misfit.mean) best = higher;
  }
  return best;
}

}  // namespace misfit::kernels
