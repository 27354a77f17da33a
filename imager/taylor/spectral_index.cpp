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

/// Noise of two images at each pixel.
class NoiseAt {
 public:
  /// The noise is measured on the images where it is the same everywhere; else in units of the expected noise `by`.
  NoiseAt(const Image& first, const Image& second, const std::optional<SolutionNoise>& by, int threads);

  NoiseOfTwo at(std::size_t i) const {
    if (!by_) return everywhere_;
    const double of_0 = by_->sigma_0.pixel[i], of_1 = by_->sigma_1.pixel[i];
    const double more =
        (by_->correlation.pixel[i] - mean_correlation_) * std::sqrt(everywhere_.variance_0 * everywhere_.variance_1);
    return {of_0 * of_0 * everywhere_.variance_0, of_1 * of_1 * everywhere_.variance_1,
            of_0 * of_1 * (everywhere_.covariance + more)};
  }

 private:
  const std::optional<SolutionNoise>& by_;
  NoiseOfTwo everywhere_;
  double mean_correlation_ = 0;
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

Image divided(Image image, const Image& by) {
  for (std::size_t i = 0; i < image.pixel.size(); ++i) image.pixel[i] /= by.pixel[i];
  return image;
}

double mean_of_known(const Image& image) {
  double sum = 0, known = 0;
  for (const double pixel : image.pixel)
    if (!std::isnan(pixel)) sum += pixel, ++known;
  return known > 0 ? sum / known : 0;
}

NoiseAt::NoiseAt(const Image& first, const Image& second, const std::optional<SolutionNoise>& by, int threads) : by_(by) {
  everywhere_ =
      by ? noise_of(divided(first, by->sigma_0), divided(second, by->sigma_1), threads) : noise_of(first, second, threads);
  if (by) mean_correlation_ = mean_of_known(by->correlation);
}

/// α and β of images [term], NaN where `is_known(pixel)` is false or I_0 is not positive.
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

SpectralImages spectral_images(const std::vector<Image>& restored, const std::vector<Image>& residual, int threads,
                               const std::optional<SolutionNoise>& by) {
  const NoiseAt noise_at(residual[0], residual[1], by, threads);
  const double level_jy = enough * robust_noise(residual[0], threads);
  SpectralImages made = indices_of(restored, threads, [&](std::size_t i) {
    return restored[0].pixel[i] >= (by ? enough * std::sqrt(noise_at.at(i).variance_0) : level_jy);
  });
  made.level_jy = level_jy;
  made.alpha_error = Image(made.alpha.width, made.alpha.height);
  for (std::size_t i = 0; i < made.alpha.pixel.size(); ++i) {
    const double alpha = made.alpha.pixel[i];
    const NoiseOfTwo noise = noise_at.at(i);
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
