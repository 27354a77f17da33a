#pragma once

#include "imager/data/image.h"
#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// 1.4826 × the median absolute deviation from the median: the standard deviation of the noise where few pixels hold sources.
/// Pixels that are not finite do not count.
double robust_noise(const Image& image, int threads = 1);

/// Measures the robust noise of a quarter of a million pixels or somewhat more, evenly spread: right to 2e-3 where they are
/// noise.
double sampled_noise(const Image& image);
double sampled_noise(const float* pixel, std::size_t pixels);

}  // namespace misfit::imager
