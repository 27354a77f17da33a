#pragma once

#include <cstddef>

#include "imager/data/image.h"

namespace misfit::imager {

/// The statistics of an image's pixels that are not NaN, from one pass.
struct ImageStatistics {
  std::size_t count = 0;
  double square_sum = 0;
  double least = 0;  ///< 0 where there are none
  double largest = 0;

  /// √(mean of squares); 0 where there are none.
  double root_mean_square() const;
  double largest_magnitude() const;
};

ImageStatistics statistics_of(const Image& image);
/// The statistics by several threads; the same for any number of them.
ImageStatistics statistics_of(const Image& image, int threads);

/// Divides all pixels, and returns their statistics after that.
ImageStatistics divide(Image& image, double by);

/// √(mean of squares) of the pixels that are not NaN; 0 where there are none.
double root_mean_square(const Image& image);

/// The largest magnitude of a pixel; 0 where every pixel is NaN.
double largest_magnitude(const Image& image);

/// The pixel of largest magnitude.
struct Peak {
  int row = 0;
  int column = 0;
  double value = 0;
};
/// The pixel of largest magnitude; the first in row-major order where several are equal. NaN is no peak, unless every pixel is
/// NaN. The image must have a pixel.
Peak find_peak(const Image& image);
/// The peak of an image with these statistics.
Peak find_peak(const Image& image, const ImageStatistics& statistics);

}  // namespace misfit::imager
