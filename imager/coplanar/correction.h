#pragma once

#include <vector>

#include "kernels/kernel.h"

namespace misfit::imager {

/// The optimal correction h of a kernel at each of an axis' pixels, the middle one lying at x = 0.
std::vector<double> axis_correction(const kernels::Kernel& kernel, int pixels, int fft_size);

/// The optimal correction h(x) of a kernel at any |x| ≤ x0, as a Chebyshev series in x²: quick where every pixel has an x of
/// its own. True to `tolerance` times its largest value, slightly beyond x0 too.
struct SmoothCorrection {
  double scale = 0;                 ///< x² times this, less 1, is the series' argument
  std::vector<double> coefficient;  ///< of Chebyshev polynomials

  SmoothCorrection(const kernels::Kernel& kernel, double tolerance);
};

}  // namespace misfit::imager
