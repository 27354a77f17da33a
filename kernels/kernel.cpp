#include "kernels/kernel.h"

#include <limits>

namespace misfit::kernels {

Kernel make_kernel(const std::string& name, double x0, const TapFunction& taps) {
  // Powers of t amplify rounding with their degree; 16 is where that outgrows what a term can still add.
  constexpr int highest_degree = 16;
  const double target = 1.005 * judge(taps, x0).mean;
  Kernel best{name, x0, {}, {.mean = std::numeric_limits<double>::infinity()}};
  for (int degree = 0; degree <= highest_degree && best.misfit.mean > target; ++degree) {
    const PiecewisePolynomial polynomial = fit_polynomial(taps, degree);
    const Misfit judged = judge(polynomial, x0);
    if (judged.mean < best.misfit.mean) best = {name, x0, polynomial, judged};
  }
  return best;
}

}  // namespace misfit::kernels
