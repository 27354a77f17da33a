#pragma once

#include "imager/image.h"

namespace misfit::imager {

/// 1.4826 × the median absolute deviation from the median: the standard deviation of the noise where few pixels hold sources.
/// Pixels that are not finite do not count.
double robust_noise(const Image& image, int threads = 1);

/// The same of a quarter of a million of its pixels, evenly spread: right to 2e-3 where that is noise.
double sampled_noise(const Image& image);

/// √(mean of squares) of the pixels that are not NaN; 0 where there are none.
double root_mean_square(const Image& image);

/// The pixel of largest magnitude.
struct Peak {
  int row = 0;
  int column = 0;
  double value = 0;
};
/// The first of them in row-major order where several are equal. NaN is no peak, unless every pixel is NaN. The image must have
/// a pixel.
Peak find_peak(const Image& image);

/// That magnitude; 0 where every pixel is NaN.
double largest_magnitude(const Image& image);

}  // namespace misfit::imager
