#include "kernels/kernel.h"

#include <algorithm>

namespace misfit::kernels {

Kernel make_kernel(const std::string& name, double x0, const TapFunction& function, const std::optional<Origin>& origin) {
  const double scale = optimal_correction(function, Eigen::VectorXd::Zero(1))[0];
  const TapFunction taps = [&function, scale](double t) { return Eigen::VectorXd(scale * function(t)); };
  constexpr double true_value = 1e-10;
  constexpr double true_to_error = 1e-7;
  Kernel kernel{name, x0, {}, {}, {}};
  if (origin) {
    kernel.origin = *origin;
  } else {
    const Misfit misfit = judge(taps, x0);
    kernel.origin.mean_error = misfit.mean;
    kernel.origin.max_error = misfit.max;
  }
  const double gain = noise_gain(taps, x0);
  const double allowed = std::min(true_value * true_value, true_to_error * kernel.origin.mean_error / (gain * gain));
  kernel.polynomial = fit_polynomial_within(taps, allowed);
  kernel.polynomial.coefficient *= optimal_correction(kernel.polynomial, Eigen::VectorXd::Zero(1))[0];
  kernel.misfit = judge(kernel.polynomial, x0);
  return kernel;
}

Kernel truncated(const Kernel& kernel, int degree) {
  if (degree >= kernel.polynomial.degree()) return kernel;
  Kernel cut = kernel;
  cut.polynomial = fit_polynomial(kernel.polynomial, degree);
  cut.misfit = judge(cut.polynomial, cut.x0);
  return cut;
}

}  // namespace misfit::kernels
