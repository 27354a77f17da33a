#include "imager/data/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr std::size_t chunk_pixels = std::size_t{1} << 16;

/// The step that spreads so many samples over an image, or some more; odd, so that they lie in every column of images whose
/// width is a power of two.
std::size_t step_of_sample(std::size_t pixels, std::size_t samples) {
  const std::size_t step = std::max<std::size_t>(pixels / samples, 1);
  return step - (step + 1) % 2;
}

/// Values within bounds, and how many there are below them and in all. NaN does not count.
struct Bracket {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::size_t below = 0;
  std::size_t all = 0;
  std::vector<double> within;

  /// Counts values without branches, since which values lie within is random.
  template <typename ValueOf>
  void look(const double* pixel, std::size_t count, const ValueOf& value_of) {
    constexpr std::size_t together = 1024;
    double value[together];
    double kept[together];
    for (const double* end = pixel + count; pixel != end;) {
      const std::size_t n = std::min(together, static_cast<std::size_t>(end - pixel));
      for (std::size_t i = 0; i < n; ++i) value[i] = value_of(pixel[i]);
      for (std::size_t i = 0; i < n; ++i) all += value[i] == value[i] ? 1 : 0;
      for (std::size_t i = 0; i < n; ++i) below += value[i] < low ? 1 : 0;
      std::size_t k = 0;
      for (std::size_t i = 0; i < n; ++i) {
        kept[k] = value[i];
        k += static_cast<std::size_t>(static_cast<int>(value[i] >= low) & static_cast<int>(value[i] <= high));
      }
      within.insert(within.end(), kept, kept + k);
      pixel += n;
    }
  }
  void join(const Bracket& other) {
    below += other.below;
    all += other.all;
    within.insert(within.end(), other.within.begin(), other.within.end());
  }
};

/// Bounds between which the middle value all but certainly lies, as a sample shows.
template <typename ValueOf>
Bracket around_median(const Image& image, const ValueOf& value_of) {
  constexpr std::size_t samples = 32768;
  Bracket sample;
  const std::size_t step = step_of_sample(image.pixel.size(), samples);
  for (std::size_t i = 0; i < image.pixel.size(); i += step) sample.look(&image.pixel[i], 1, value_of);
  std::vector<double>& value = sample.within;
  if (value.size() < samples / 2) return {};
  // 5.7 standard deviations of the middle's place in a random sample
  const auto reach = static_cast<std::ptrdiff_t>(2.85 * std::sqrt(static_cast<double>(value.size())));
  const auto low = value.begin() + static_cast<std::ptrdiff_t>(value.size() / 2) - reach;
  const auto high = low + 2 * reach;
  std::nth_element(value.begin(), low, value.end());
  std::nth_element(low + 1, high, value.end());
  return {*low, *high, 0, 0, {}};
}

/// The middle of the values of all pixels, the upper one of two; 0 where there is none. Only values near it are put in order.
template <typename ValueOf>
double median(const Image& image, int threads, const ValueOf& value_of) {
  const std::size_t pixels = image.pixel.size();
  for (Bracket bounds = around_median(image, value_of);; bounds = {}) {
    std::vector<Bracket> part((pixels + chunk_pixels - 1) / chunk_pixels, bounds);
    parallel_for(part.size(), threads, [&](std::size_t i) {
      const std::size_t first = i * chunk_pixels;
      part[i].look(&image.pixel[first], std::min(chunk_pixels, pixels - first), value_of);
    });
    for (const Bracket& some : part) bounds.join(some);
    if (bounds.all == 0) return 0;
    const std::size_t rank = bounds.all / 2;
    if (bounds.below > rank || rank - bounds.below >= bounds.within.size()) continue;
    const auto middle = bounds.within.begin() + static_cast<std::ptrdiff_t>(rank - bounds.below);
    std::nth_element(bounds.within.begin(), middle, bounds.within.end());
    return *middle;
  }
}

template <typename Real>
double noise_of_sample(const Real* pixel, std::size_t pixels) {
  constexpr std::size_t enough = std::size_t{1} << 18;
  const std::size_t step = step_of_sample(pixels, enough);
  Image some;
  some.pixel.reserve(pixels / step + 1);
  for (std::size_t i = 0; i < pixels; i += step) some.pixel.push_back(double{pixel[i]});
  return robust_noise(some);
}

}  // namespace

double robust_noise(const Image& image, int threads) {
  const auto finite = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::quiet_NaN(); };
  const double centre = median(image, threads, finite);
  return 1.4826 * median(image, threads, [&](double x) { return std::abs(finite(x) - centre); });
}

double sampled_noise(const Image& image) {
  return noise_of_sample(image.pixel.data(), image.pixel.size());
}

double sampled_noise(const float* pixel, std::size_t pixels) {
  return noise_of_sample(pixel, pixels);
}

}  // namespace misfit::imager
