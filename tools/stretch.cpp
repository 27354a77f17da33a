#include "tools/stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/noise.h"
#include "tools/numbers.h"

namespace misfit::tools {
namespace {

std::vector<double> linear_tick_values(const Stretch& stretch) {
  const double rough = (stretch.high - stretch.low) / 5;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = rough < 1.5 * decade   ? decade
                      : rough < 3.5 * decade ? 2 * decade
                      : rough < 7.5 * decade ? 5 * decade
                                             : 10 * decade;
  std::vector<double> values;
  for (double n = std::ceil(stretch.low / step - 1e-9); n * step <= stretch.high * (1 + 1e-9); ++n) values.push_back(n * step);
  return values;
}

std::vector<double> asinh_tick_values(const Stretch& stretch) {
  std::vector<double> values{0};
  const double first = std::pow(10.0, std::floor(std::log10(stretch.knee)));
  for (double decade = first; decade <= stretch.high; decade *= 10) {
    for (const double value : {decade, 3 * decade}) {
      if (value < stretch.knee * 0.9) continue;
      if (value <= stretch.high) values.push_back(value);
      if (-value >= stretch.low) values.insert(values.begin(), -value);
    }
  }
  return values;
}

/// Every few pixels of a large image, enough for its noise.
imager::Image sample(const imager::Image& image) {
  constexpr std::size_t enough = 1 << 18;
  const std::size_t step = image.pixel.size() / enough | 1;  // odd, so that it meets every column
  imager::Image some;
  for (std::size_t i = 0; i < image.pixel.size(); i += step) some.pixel.push_back(image.pixel[i]);
  return some;
}

}  // namespace

double Stretch::operator()(double value) const {
  return knee > 0 ? std::asinh(value / knee) : value;
}

Stretch choose_stretch(const imager::Image& image) {
  double min = HUGE_VAL, max = -HUGE_VAL;
  for (const double value : image.pixel) {
    if (!std::isfinite(value)) continue;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  if (min > max) return {};
  if (min == max) return {.low = std::min(0.0, min), .high = min < 0 ? 0 : min > 0 ? min : 1};

  const double noise = imager::robust_noise(sample(image));
  Stretch stretch{.low = min, .high = max, .sparse = noise == 0};
  if (max <= 0) return stretch;
  if (max > 30 * noise) stretch.knee = stretch.sparse ? max / 300 : 3 * noise;
  stretch.low = std::max(min, stretch.sparse ? -stretch.knee : -3 * noise);
  return stretch;
}

std::vector<Tick> stretch_ticks(const Stretch& stretch) {
  const std::vector<double> values = stretch.knee > 0 ? asinh_tick_values(stretch) : linear_tick_values(stretch);
  std::vector<Tick> ticks;
  ticks.reserve(values.size());
  for (const double value : values) ticks.push_back({value, significant(value, 2)});
  return ticks;
}

ReducedImage reduce(const imager::Image& image, int most) {
  const int block = std::max(1, (std::max(image.width, image.height) + most - 1) / most);
  if (block == 1) return {image, 1};
  imager::Image blocks((image.width + block - 1) / block, (image.height + block - 1) / block);
  std::fill(blocks.pixel.begin(), blocks.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const double value = image.at(row, column);
      double& kept = blocks.at(row / block, column / block);
      if (std::isfinite(value) && !(std::abs(kept) >= std::abs(value))) kept = value;
    }
  }
  return {std::move(blocks), block};
}

}  // namespace misfit::tools
