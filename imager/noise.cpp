#include "imager/noise.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double robust_noise(const Image& image) {
  std::vector<double> values = image.pixel;
  if (values.empty()) return 0;
  const double centre = median(values);
  for (double& value : values) value = std::abs(value - centre);
  return 1.4826 * median(values);
}

double root_mean_square(const Image& image) {
  double square = 0;
  for (const double pixel : image.pixel) square += pixel * pixel;
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(image.pixel.size(), 1)));
}

Peak find_peak(const Image& image) {
  const auto largest =
      std::max_element(image.pixel.begin(), image.pixel.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto index = static_cast<int>(largest - image.pixel.begin());
  return {index / image.width, index % image.width, *largest};
}

}  // namespace misfit::imager
