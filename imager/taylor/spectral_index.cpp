#include "imager/taylor/spectral_index.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"

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

/// α and β of images [term], NaN where `is_known(pixel)` is not so or I_0 is not positive.
template <typename IsKnown>
SpectralImages indices_of(const std::vector<Image>& term, int threads, const IsKnown& is_known) {
  const int width = term.front().width, height = term.front().height;
  const bool has_beta = term.size() > 2;
  SpectralImages made{Image(width, height), {}, has_beta ? Image(width, height) : Image()};
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto columns = static_cast<std::size_t>(width);
  parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
    for (std::size_t i = row * columns; i < (row + 1) * columns; ++i) {
      const double flux = term[0].pixel[i];
      const double alpha = is_known(i) && flux > 0 ? term[1].pixel[i] / flux : unknown;
      made.alpha.pixel[i] = alpha;
      if (has_beta) made.beta.pixel[i] = term[2].pixel[i] / flux - alpha * (alpha - 1) / 2;
    }
  });
  return made;
}

}  // namespace

SpectralImages spectral_images(const std::vector<Image>& restored, const std::vector<Image>& residual, int threads) {
  const NoiseOfTwo noise = noise_of(residual[0], residual[1], threads);
  const double level_jy = enough * std::sqrt(noise.variance_0);
  SpectralImages made = indices_of(restored, threads, [&](std::size_t i) { return restored[0].pixel[i] >= level_jy; });
  made.level_jy = level_jy;
  made.alpha_error = Image(made.alpha.width, made.alpha.height);
  for (std::size_t i = 0; i < made.alpha.pixel.size(); ++i) {
    const double alpha = made.alpha.pixel[i];
    const double variance = noise.variance_1 - 2 * alpha * noise.covariance + alpha * alpha * noise.variance_0;
    made.alpha_error.pixel[i] = std::isnan(alpha) ? alpha : std::sqrt(std::fmax(0, variance)) / restored[0].pixel[i];
  }
  return made;
}

SpectralImages spectral_images_of_sky(const std::vector<Image>& sky, const SpectralImages& apparent, int threads) {
  SpectralImages made = indices_of(sky, threads, [&](std::size_t i) { return !std::isnan(apparent.alpha.pixel[i]); });
  made.level_jy = apparent.level_jy;
  return made;
}

}  // namespace misfit::imager
