#pragma once

#include <vector>

#include "imager/data/image.h"

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

/// Convolved with the unit Gaussian of a scale; as it is where that is 0.
Image blurred(const Image& image, double scale_pixels, int threads);

/// [scale][pixel]: whether a component may be put there.
using ScalePlaces = std::vector<std::vector<bool>>;

/// Where nine tenths of a scale's Gaussian lie within the mask (null: everywhere) and on pixels that are not NaN, and two of
/// its widths within the image.
ScalePlaces scale_places(const Image& residual, const Image* mask, const MultiscaleOptions& options);

/// The largest magnitude at `places`; other pixels become NaN.
double peak_at(const std::vector<bool>& places, Image& image, int threads);

/// A residual is smooth over the scale that it was convolved with, and as well fitted from every third pixel of fifteen: others
/// than those become NaN, counted from the peak.
void thin(Image& residual, double scale_pixels, int threads);

}  // namespace misfit::imager
