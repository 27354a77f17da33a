#include "kernels/families/tuned.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/map_error.h"
#include "kernels/quadrature.h"

namespace misfit::kernels {
namespace {

constexpr int tuned_min_width = 2;  // a single cell hardly wants a taper: for small x0 its best β is 0

/// E for one width and x0 as a function of β, with as many nodes in x as its zeros and its rise towards x0 need.
class MeanError {
 public:
  MeanError(const TapsOfParameter& taps, int width, double x0)
      : taps_(taps), width_(width), x0_(x0), x_(gauss_legendre(14 + width + width / 2 + (x0 > 0.42 ? 8 : 0), 0, x0)) {}

  /// About the best β of all such functions: it concentrates their transform in |x| < 1 − x0, whose aliases stay off |x| < x0.
  double natural() const { return std::numbers::pi * width_ * (1 - x0_); }

  double operator()(double parameter) const { return x_.weight.dot(map_error(taps_(width_, parameter), x_.node)) / x0_; }

 private:
  const TapsOfParameter& taps_;
  int width_;
  double x0_;
  Quadrature x_;
};

/// The minimum between `low` and `high` by golden sections, to `tolerance`.
double golden_section(const MeanError& error, double low, double high, double tolerance) {
  const double shrink = std::numbers::phi - 1;
  double left = high - shrink * (high - low);
  double right = low + shrink * (high - low);
  double at_left = error(left);
  double at_right = error(right);
  while (high - low > tolerance) {
    const bool go_left = at_left < at_right;
    (go_left ? high : low) = go_left ? right : left;
    if (go_left) {
      right = left;
      at_right = at_left;
      left = high - shrink * (high - low);
      at_left = error(left);
    } else {
      left = right;
      at_left = at_right;
      right = low + shrink * (high - low);
      at_right = error(right);
    }
  }
  return (low + high) / 2;
}

/// The widest function up to `width` whose E is not rounding, some 1e-31.
int widest_clear_of_rounding(const TapsOfParameter& taps, int width, double x0) {
  constexpr double clear = 1e-25;
  for (; width > tuned_min_width; --width) {
    const MeanError error(taps, width, x0);
    if (error(error.natural()) >= clear) break;
  }
  return width;
}

/// The global minimum. It lies below the natural parameter, most so for short functions, or a percent above; for small x0 there
/// are several minima, about natural/(2W) apart.
double minimum(const MeanError& error, int width) {
  constexpr int steps = 24;
  const double low = error.natural() * (1 - 1.0 / width);
  const double step = (1.06 * error.natural() - low) / steps;
  double best = low;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const double mean_error = error(low + i * step);
    if (mean_error >= least) continue;
    least = mean_error;
    best = low + i * step;
  }
  return golden_section(error, best - step, best + step, 1e-4 * best);
}

}  // namespace

double tune_parameter(const TapsOfParameter& taps, int width, double x0) {
  // Where E would be rounding, β per cell is that of a narrower function: it hardly changes any more with width.
  const int judged = widest_clear_of_rounding(taps, width, x0);
  return minimum(MeanError(taps, judged, x0), judged) * width / judged;
}

KernelFamily tuned_family(const std::string& name, const std::string& description, const TapsOfParameter& taps) {
  return {name, description, tuned_min_width, 20, 0.01, 0.49, [name, taps](int width, double x0) {
            const double parameter = tune_parameter(taps, width, x0);
            Kernel kernel = make_kernel(name, x0, taps(width, parameter));
            kernel.origin.parameter = parameter;
            return kernel;
          }};
}

}  // namespace misfit::kernels
