#include "tools/drawing/stretch.h"

#include <algorithm>
#include <cmath>

#include "imager/data/noise.h"
#include "tools/base/numbers.h"
#include "tools/drawing/ticks.h"

namespace misfit::tools {
namespace {

constexpr double mark_rounding = 1e-3;  // a PSF whose peak is not quite 1 has a mark there all the same

/// 0 and ±`factors` × 10^k beyond the knee, from the lowest to the highest.
std::vector<double> asinh_tick_values(const Stretch& stretch, const std::vector<double>& factors, int every) {
  std::vector<double> values{0};
  const int first = static_cast<int>(std::floor(std::log10(stretch.knee)));
  for (int power = first; std::pow(10.0, power) <= std::max(stretch.high, -stretch.low) * (1 + mark_rounding); power += every) {
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, power);
      if (value < stretch.knee * 0.9) continue;
      if (value <= stretch.high * (1 + mark_rounding)) values.push_back(value);
      if (-value >= stretch.low * (1 + mark_rounding)) values.insert(values.begin(), -value);
    }
  }
  if (stretch.low > 0) values.erase(std::find(values.begin(), values.end(), 0.0));
  return values;
}

std::vector<double> tick_values(const Stretch& stretch) {
  if (stretch.knee == 0) return linear_ticks(stretch.low, stretch.high, 5);
  constexpr std::size_t most = 12;
  std::vector<double> values = asinh_tick_values(stretch, {1, 3}, 1);
  for (int every = 1; values.size() > most; ++every) values = asinh_tick_values(stretch, {1}, every);
  return values;
}

/// The magnitude that nine tenths of the pixels that are not zero exceed, but at least 1e-4 of `largest`, the magnitude of one
/// of these.
double faint(const imager::Image& image, double largest) {
  constexpr std::size_t enough = 1 << 18;
  std::vector<double> magnitudes;
  for (const double value : image.pixel)
    if (value != 0 && std::isfinite(value) && magnitudes.size() < enough) magnitudes.push_back(std::abs(value));
  const auto tenth = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 10);
  std::nth_element(magnitudes.begin(), tenth, magnitudes.end());
  return std::max(*tenth, 1e-4 * largest);
}

Stretch stretch_about_zero(const Stretch& range, double noise, double knee) {
  const double largest = std::max(range.high, -range.low);
  return {.low = range.low < 0 ? -largest : 0, .high = largest, .knee = largest > 8 * noise ? knee : 0, .sparse = range.sparse};
}

}  // namespace

double Stretch::operator()(double value) const {
  return knee > 0 ? std::asinh(value / knee) : value;
}

Stretch choose_stretch(const imager::Image& image, Shades shades) {
  double min = HUGE_VAL, max = -HUGE_VAL;
  for (const double value : image.pixel) {
    if (!std::isfinite(value)) continue;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  if (min > max) return {};
  if (min == max) return {.low = std::min(0.0, min), .high = min < 0 ? 0 : min > 0 ? min : 1};

  const double noise = imager::sampled_noise(image);
  Stretch stretch{.low = min, .high = max, .sparse = noise == 0};
  const double knee = stretch.sparse ? faint(image, std::max(max, -min)) : 3 * noise;
  if (shades == Shades::about_zero) return stretch_about_zero(stretch, noise, knee);
  if (max <= 0) return stretch;
  if (max > 30 * noise) stretch.knee = knee;
  stretch.low = std::max(min, -knee);
  return stretch;
}

std::vector<Tick> stretch_ticks(const Stretch& stretch) {
  std::vector<Tick> ticks;
  for (const double value : tick_values(stretch))
    ticks.push_back({std::clamp(value, stretch.low, stretch.high), significant(value, 2)});
  return ticks;
}

}  // namespace misfit::tools
