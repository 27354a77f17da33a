#include "imager/plan/gridding_candidate.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"
#include "kernels/cheapest_polynomial.h"

namespace misfit::imager {
namespace {

/// Relative RMS of the rounding of taps, sums and FFT for a noise gain of 1, as measured: in single precision it grows with the
/// number of samples, since sums do.
double unit_rounding(Precision precision, double samples) {
  if (precision == Precision::double_precision) return 2.2e-16;  // twice the unit of rounding
  // Taps and FFT; and sums of buffers on their way to the grid, of which the fullest cells take most.
  return std::hypot(2.8e-7, 2.4e-8 * std::sqrt(samples / 2e5));
}

/// The RMS over the image of the amplification by all corrections. Over u and v it is the product; but along w a pixel lies
/// where its n − 1 does, and the corners, where u and v amplify most, lie at one end, where w does. There are two bounds: with
/// the largest along w; or along u and v, where n − 1 takes any value at most π/2 times as often as a uniform one, as a
/// paraboloid over a square does.
double image_gain(const AxisKernel& u, const AxisKernel& v, const AxisKernel& w) {
  const double denser = std::sqrt(pi / 2);
  return std::min(u.noise_gain * v.noise_gain * w.largest_gain, u.largest_gain * v.largest_gain * w.noise_gain * denser);
}

}  // namespace

double phase_rounding(double turns) {
  return 1.1e-16 * (1 + 2 * pi * turns);
}

void judge(GriddingCandidate& c) {
  const double sums = image_gain(c.u, c.v, c.w) * unit_rounding(c.work.precision, c.work.samples);
  c.rounding = std::hypot(sums, phase_rounding(c.turns));
  const kernels::Misfit &u = c.u.misfit, &v = c.v.misfit;
  kernels::Misfit w = c.w.misfit;
  const int pixels = std::min(c.faceting.width, c.faceting.height);
  constexpr int handful = 16;
  if (pixels < handful) w.mean = w.max;  // the few pixels may all lie where it errs most
  if (pixels < continuum) w.worst_mean = w.worst;
  // An image of a single visibility at the worst position of its cell, or the visibilities of a single pixel at the corner.
  const double worst = std::max(u.worst_mean + v.worst_mean + w.worst_mean, u.max + v.max + w.max);
  c.expected_error = std::hypot(std::sqrt(u.mean + v.mean + w.mean), c.rounding);
  c.worst_error = std::hypot(std::sqrt(worst), c.rounding);
}

GriddingCandidate with_shortest_polynomials(const GriddingCandidate& exact) {
  GriddingCandidate simple = exact;
  const double rounding2 = exact.rounding * exact.rounding / 2;  // of one axis, which hides what is smaller
  const auto cut = [&](AxisKernel& axis) {
    const double excess = 0.005 * (1 + rounding2 / std::max(axis.kernel.misfit.mean, 1e-40));
    axis.kernel.polynomial = kernels::cheapest_polynomial(axis.kernel, excess);
    axis.kernel.misfit = kernels::judge(axis.kernel.polynomial, axis.kernel.x0);
  };
  cut(simple.u);
  cut(simple.v);
  simple.u.misfit = axis_misfit(simple.u.kernel, exact.faceting.width, exact.work.nu);
  simple.v.misfit = axis_misfit(simple.v.kernel, exact.faceting.height, exact.work.nv);
  if (exact.work.has_w_axis()) {
    cut(simple.w);
    simple.w.misfit = simple.w.kernel.misfit;
  }
  judge(simple);
  return simple;
}

}  // namespace misfit::imager
