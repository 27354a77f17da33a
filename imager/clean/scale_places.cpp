#include "imager/clean/scale_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "imager/clean/gaussian_blur.h"
#include "imager/clean/mask.h"
#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void check_scales(const MultiscaleOptions& o) {
  if (o.scale_pixels.empty()) throw std::invalid_argument("no scales: expected one at least");
  for (std::size_t s = 0; s < o.scale_pixels.size(); ++s) {
    const double scale = o.scale_pixels[s];
    if (!(std::isfinite(scale) && scale >= 0) || (s > 0 && !(scale > o.scale_pixels[s - 1])))
      throw std::invalid_argument("scale " + std::to_string(scale) + ": expected ascending numbers of pixels, 0 or more");
  }
  if (!(o.small_scale_bias >= 0 && o.small_scale_bias < 1))
    throw std::invalid_argument("small-scale bias " + std::to_string(o.small_scale_bias) + ": expected 0 or more, and below 1");
}

Image blurred(const Image& image, double scale_pixels, int threads) {
  return scale_pixels == 0 ? image : gaussian_blur(image, scale_pixels, threads);
}

ScalePlaces scale_places(const Image& residual, const Image* mask, const MultiscaleOptions& options) {
  constexpr double enough = 0.9;
  Image allowed(residual.width, residual.height);
  for (std::size_t i = 0; i < allowed.pixel.size(); ++i)
    allowed.pixel[i] = (mask == nullptr || mask_allows(mask->pixel[i])) && !std::isnan(residual.pixel[i]) ? 1 : 0;
  ScalePlaces result;
  for (const double scale : options.scale_pixels) {
    const Image within = blurred(allowed, scale, options.threads);
    std::vector<bool>& places = result.emplace_back(within.pixel.size());
    const int border = static_cast<int>(std::ceil(2 * scale));  // beyond lies a millionth
    for (int r = border; r < within.height - border; ++r)
      for (int c = border; c < within.width - border; ++c) {
        const std::size_t i =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(within.width) + static_cast<std::size_t>(c);
        places[i] = allowed.pixel[i] != 0 && within.pixel[i] >= enough;
      }
  }
  return result;
}

double peak_at(const std::vector<bool>& places, Image& image, int threads) {
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<double> peak(static_cast<std::size_t>(image.height));
  parallel_for(peak.size(), threads, [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      if (places[i])
        peak[row] = std::max(peak[row], std::abs(image.pixel[i]));
      else
        image.pixel[i] = none;
    }
  });
  return *std::max_element(peak.begin(), peak.end());
}

void thin(Image& residual, double scale_pixels, int threads) {
  const int step = static_cast<int>(scale_pixels / 5);
  if (step < 2) return;
  const Peak peak = find_peak(residual);
  parallel_for(static_cast<std::size_t>(residual.height), threads, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < residual.width; ++c)
      if ((r - peak.row) % step != 0 || (c - peak.column) % step != 0) residual.at(r, c) = none;
  });
}

}  // namespace misfit::imager
