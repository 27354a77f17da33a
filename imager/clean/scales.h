#pragma once

#include <vector>

namespace misfit::imager {

struct MultiscaleOptions {
  /// Full widths at half maximum of round Gaussians in pixels, ascending; 0 for points.
  std::vector<double> scale_pixels{0};
  /// Between 0 and 1: the merit of a scale is multiplied by 1 − this × scale / largest scale.
  double small_scale_bias = 0;
  int threads = 1;
};

/// Throws std::invalid_argument when there is no scale, one is not finite or negative, they do not ascend, or the bias is not
/// in [0, 1).
void check_scales(const MultiscaleOptions& options);

/// A scale at which residuals are looked at.
struct LookedAt {
  double pixels = 0;  ///< full width at half maximum of its Gaussian; 0 = points
  int index = -1;     ///< among the options' scales; −1 for points that only tell whether a threshold is reached
  double bias = 1;
  int step = 1;  ///< it is looked at in every step-th pixel of every step-th row: a power of two, a fifth of its width at most
};

/// The scales looked at, points first, whether components may be points or not.
std::vector<LookedAt> scales_looked_at(const MultiscaleOptions& options);

}  // namespace misfit::imager
