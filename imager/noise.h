#pragma once

#include "imager/image.h"

namespace misfit::imager {

/// 1.4826 × the median absolute deviation from the median: the standard deviation of the noise where few pixels hold sources.
double robust_noise(const Image& image);

/// √(mean of squares); 0 of an image without pixels.
double root_mean_square(const Image& image);

/// The pixel of largest magnitude.
struct Peak {
  int row = 0;
  int column = 0;
  double value = 0;
};
/// The first of them in row-major order where several are equal. The image must have a pixel.
Peak find_peak(const Image& image);

}  // namespace misfit::imager
