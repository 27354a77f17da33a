#include "imager/noise.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace misfit::imager {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double robust_noise(const Image& image) {
  std::vector<double> values;
  values.reserve(image.pixel.size());
  std::copy_if(image.pixel.begin(), image.pixel.end(), std::back_inserter(values), [](double x) { return std::isfinite(x); });
  if (values.empty()) return 0;
  const double centre = median(values);
  for (double& value : values) value = std::abs(value - centre);
  return 1.4826 * median(values);
}

double root_mean_square(const Image& image) {
  double square = 0;
  std::size_t pixels = 0;
  for (const double pixel : image.pixel) {
    if (std::isnan(pixel)) continue;
    square += pixel * pixel;
    ++pixels;
  }
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(pixels, 1)));
}

Peak find_peak(const Image& image) {
  std::size_t at = 0;
  double largest = -1;
  for (std::size_t i = 0; i < image.pixel.size(); ++i) {
    if (!(std::abs(image.pixel[i]) > largest)) continue;
    largest = std::abs(image.pixel[i]);
    at = i;
  }
  const auto width = static_cast<std::size_t>(image.width);
  return {static_cast<int>(at / width), static_cast<int>(at % width), image.pixel[at]};
}

double largest_magnitude(const Image& image) {
  const double peak = std::abs(find_peak(image).value);
  return std::isnan(peak) ? 0 : peak;
}

}  // namespace misfit::imager
