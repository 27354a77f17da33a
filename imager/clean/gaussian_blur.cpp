#include "imager/clean/gaussian_blur.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/parallel.h"

namespace misfit::imager {
namespace {

/// [0] in the middle, the others on either side of it; their sum over both sides is 1.
std::vector<double> half_taps(double fwhm_pixels) {
  constexpr double cut = 1e-9;
  const double rate = 4 * std::log(2.0) / (fwhm_pixels * fwhm_pixels);
  const auto reach = static_cast<std::size_t>(std::ceil(std::sqrt(-std::log(cut) / rate)));
  std::vector<double> tap(reach + 1);
  double sum = -1;
  for (std::size_t k = 0; k < tap.size(); ++k) {
    tap[k] = std::exp(-rate * static_cast<double>(k * k));
    sum += 2 * tap[k];
  }
  for (double& t : tap) t /= sum;
  return tap;
}

/// out[c] = Σ_k tap[|k|] in[c + k · stride] for c in [0, count).
void correlate(const double* in, std::ptrdiff_t stride, const std::vector<double>& tap, std::size_t count, double* out) {
  for (std::size_t c = 0; c < count; ++c) out[c] = tap[0] * in[c];
  for (std::size_t k = 1; k < tap.size(); ++k) {
    const double* const before = in - static_cast<std::ptrdiff_t>(k) * stride;
    const double* const after = in + static_cast<std::ptrdiff_t>(k) * stride;
    for (std::size_t c = 0; c < count; ++c) out[c] += tap[k] * (before[c] + after[c]);
  }
}

void blur_rows(Image& image, const std::vector<double>& tap, int threads) {
  const std::size_t reach = tap.size() - 1, width = static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(image.height), threads, [&](std::size_t r) {
    std::vector<double> padded(width + 2 * reach);
    double* const row = image.row(static_cast<int>(r));
    std::transform(row, row + width, padded.begin() + static_cast<std::ptrdiff_t>(reach),
                   [](double x) { return std::isnan(x) ? 0 : x; });
    correlate(&padded[reach], 1, tap, width, row);
  });
}

/// In strips of columns that fit the cache.
void blur_columns(Image& image, const std::vector<double>& tap, int threads) {
  constexpr std::size_t strip = 64;
  const std::size_t reach = tap.size() - 1, width = static_cast<std::size_t>(image.width);
  parallel_for((width + strip - 1) / strip, threads, [&](std::size_t s) {
    const std::size_t first = s * strip, count = std::min(strip, width - first);
    std::vector<double> padded((static_cast<std::size_t>(image.height) + 2 * reach) * strip);
    for (int r = 0; r < image.height; ++r)
      std::copy_n(image.row(r) + first, count, &padded[(static_cast<std::size_t>(r) + reach) * strip]);
    for (int r = 0; r < image.height; ++r)
      correlate(&padded[(static_cast<std::size_t>(r) + reach) * strip], strip, tap, count, image.row(r) + first);
  });
}

}  // namespace

Image gaussian_blur(const Image& image, double fwhm_pixels, int threads) {
  if (!(fwhm_pixels > 0))
    throw std::invalid_argument("a Gaussian of " + std::to_string(fwhm_pixels) + " pixels: expected a width above 0");
  const std::vector<double> tap = half_taps(fwhm_pixels);
  Image result = image;
  blur_rows(result, tap, threads);
  blur_columns(result, tap, threads);
  return result;
}

}  // namespace misfit::imager
