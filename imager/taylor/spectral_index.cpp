#include "imager/taylor/spectral_index.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "imager/noise.h"
#include "imager/parallel.h"

namespace misfit::imager {
namespace {

constexpr double enough = 5;  // times the noise

struct NoiseOfTwo {
  double variance_0 = 0;
  double variance_1 = 0;
  double covariance = 0;
};

/// The covariance from the noise of sum and difference, each over its own: robust where covariance itself is not.
NoiseOfTwo noise_of(const Image& first, const Image& second, int threads) {
  const double sigma_0 = robust_noise(first, threads), sigma_1 = robust_noise(second, threads);
  NoiseOfTwo noise{sigma_0 * sigma_0, sigma_1 * sigma_1};
  if (!(sigma_0 > 0 && sigma_1 > 0)) return noise;
  const auto noise_with = [&](double sign) {
    Image combined = first;
    for (std::size_t i = 0; i < combined.pixel.size(); ++i)
      combined.pixel[i] = first.pixel[i] / sigma_0 + sign * second.pixel[i] / sigma_1;
    return robust_noise(combined, threads);
  };
  const double sum = noise_with(1), difference = noise_with(-1);
  noise.covariance = (sum * sum - difference * difference) / 4 * sigma_0 * sigma_1;
  return noise;
}

}  // namespace

SpectralImages spectral_images(const std::vector<Image>& restored, const std::vector<Image>& residual, int threads) {
  const NoiseOfTwo noise = noise_of(residual[0], residual[1], threads);
  const int width = restored.front().width, height = restored.front().height;
  const bool has_beta = restored.size() > 2;
  SpectralImages made{Image(width, height), Image(width, height), has_beta ? Image(width, height) : Image(),
                      enough * std::sqrt(noise.variance_0)};
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto columns = static_cast<std::size_t>(width);
  parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
    for (std::size_t i = row * columns; i < (row + 1) * columns; ++i) {
      const double flux = restored[0].pixel[i];
      const bool is_known = flux >= made.level_jy && flux > 0;
      const double alpha = is_known ? restored[1].pixel[i] / flux : unknown;
      made.alpha.pixel[i] = alpha;
      made.alpha_error.pixel[i] =
          std::sqrt(std::fmax(0, noise.variance_1 - 2 * alpha * noise.covariance + alpha * alpha * noise.variance_0)) / flux;
      if (!is_known) made.alpha_error.pixel[i] = unknown;
      if (has_beta) made.beta.pixel[i] = is_known ? restored[2].pixel[i] / flux - alpha * (alpha - 1) / 2 : unknown;
    }
  });
  return made;
}

}  // namespace misfit::imager
