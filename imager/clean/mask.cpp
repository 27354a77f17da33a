#include "imager/clean/mask.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

bool mask_allows(double value) {
  return value != 0 && !std::isnan(value);
}

std::size_t allowed_pixels(const Image& mask) {
  return static_cast<std::size_t>(std::count_if(mask.pixel.begin(), mask.pixel.end(), mask_allows));
}

bool mask_is_empty(const Image& mask) {
  return std::none_of(mask.pixel.begin(), mask.pixel.end(), mask_allows);
}

double largest_magnitude_within(const Image& mask, const Image& image, int threads) {
  std::vector<double> largest(static_cast<std::size_t>(image.height));
  parallel_for(largest.size(), threads, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < image.width; ++c)
      if (mask_allows(mask.at(r, c))) largest[row] = std::fmax(largest[row], std::abs(image.at(r, c)));
  });
  return *std::max_element(largest.begin(), largest.end());
}

Image masked(Image image, const Image& mask) {
  if (mask.width != image.width || mask.height != image.height)
    throw std::invalid_argument("a mask of " + std::to_string(mask.width) + " × " + std::to_string(mask.height) +
                                " pixels on an image of " + std::to_string(image.width) + " × " + std::to_string(image.height) +
                                "; expected one size");
  for (std::size_t i = 0; i < mask.pixel.size(); ++i)
    if (!mask_allows(mask.pixel[i])) image.pixel[i] = std::numeric_limits<double>::quiet_NaN();
  return image;
}

}  // namespace misfit::imager
