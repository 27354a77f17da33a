#include "imager/clean/multiscale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/clean/active_pixels.h"
#include "imager/clean/components.h"
#include "imager/clean/gaussian_blur.h"
#include "imager/clean/mask.h"
#include "imager/noise.h"
#include "imager/parallel.h"

namespace misfit::imager {
namespace {

void check(const MultiscaleOptions& o) {
  if (o.scale_pixels.empty()) throw std::invalid_argument("no scales: expected one at least");
  for (std::size_t s = 0; s < o.scale_pixels.size(); ++s) {
    const double scale = o.scale_pixels[s];
    if (!(std::isfinite(scale) && scale >= 0) || (s > 0 && !(scale > o.scale_pixels[s - 1])))
      throw std::invalid_argument("scale " + std::to_string(scale) + ": expected ascending numbers of pixels, 0 or more");
  }
  if (!(o.small_scale_bias >= 0 && o.small_scale_bias < 1))
    throw std::invalid_argument("small-scale bias " + std::to_string(o.small_scale_bias) + ": expected 0 or more, and below 1");
}

Image divided(Image image, double by) {
  for (double& pixel : image.pixel) pixel /= by;
  return image;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The largest magnitude at `places`; other pixels become NaN.
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

/// A residual is smooth over the scale that it was convolved with, and as well fitted from every third pixel of fifteen: others
/// than those become NaN, counted from the peak.
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

}  // namespace

Multiscale::Multiscale(const Image& psf, const MultiscaleOptions& options)
    : MinorCycle(psf), options_(options), convolution_(psf, options.threads) {
  check(options);
  const double largest = options.scale_pixels.back();
  for (const double scale : options.scale_pixels) {
    const Image twice = scale == 0 ? psf : gaussian_blur(psf, std::sqrt(2.0) * scale, options.threads);
    const double peak = twice.at(psf.height / 2, psf.width / 2);
    scale_.push_back({largest == 0 ? 1 : 1 - options.small_scale_bias * scale / largest, peak, PsfCore(divided(twice, peak))});
  }
}

Image Multiscale::convolved(const Image& image, std::size_t scale) const {
  const double fwhm = options_.scale_pixels[scale];
  return fwhm == 0 ? image : gaussian_blur(image, fwhm, options_.threads);
}

/// [scale][pixel]: whether a component may be put there.
std::vector<std::vector<bool>> Multiscale::places(const Image& residual, const Image* mask) const {
  constexpr double enough = 0.9;
  Image allowed(residual.width, residual.height);
  for (std::size_t i = 0; i < allowed.pixel.size(); ++i)
    allowed.pixel[i] = (mask == nullptr || mask_allows(mask->pixel[i])) && !std::isnan(residual.pixel[i]) ? 1 : 0;
  std::vector<std::vector<bool>> result;
  for (std::size_t s = 0; s < scale_.size(); ++s) {
    const Image within = convolved(allowed, s);
    std::vector<bool>& places = result.emplace_back(within.pixel.size());
    const int border = static_cast<int>(std::ceil(2 * options_.scale_pixels[s]));  // beyond lies a millionth
    for (int r = border; r < within.height - border; ++r)
      for (int c = border; c < within.width - border; ++c) {
        const std::size_t i =
            static_cast<std::size_t>(r) * static_cast<std::size_t>(within.width) + static_cast<std::size_t>(c);
        places[i] = allowed.pixel[i] != 0 && within.pixel[i] >= enough;
      }
  }
  return result;
}

Multiscale::Choice Multiscale::choose(const Image& left, const std::vector<std::vector<bool>>& places) const {
  Choice best;
  for (std::size_t s = 0; s < scale_.size(); ++s) {
    Image residual = convolved(left, s);
    const double peak = peak_at(places[s], residual, options_.threads);
    const double merit = scale_[s].bias * peak * peak / scale_[s].psf_peak;
    if (merit <= best.merit) {
      best.next_merit = std::max(best.next_merit, merit);
      continue;
    }
    best = {s, merit, best.merit, std::move(residual)};
  }
  return best;
}

MinorCycleReport Multiscale::clean(const Image& residual, const MinorCycleOptions& options) const {
  constexpr double merit_left = 0.5;
  constexpr double least_merit = 0.01;  // of a point's at the threshold: no scale sees what is left
  require_size(residual, options);
  const std::vector<std::vector<bool>> allowed = places(residual, options.mask);
  const auto peak_of = [&](const Image& image) {
    return largest_magnitude(options.mask == nullptr ? image : masked(image, *options.mask));
  };
  MinorCycleReport report;
  Image left = residual;
  double peak = peak_of(left);
  const MinorCycleWatch watch(options, peak);
  while (!watch.ends(peak, report)) {
    Choice choice = choose(left, allowed);
    if (!(choice.merit > least_merit * options.threshold_jy * options.threshold_jy)) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    const Scale& scale = scale_[choice.scale];
    const bool point = options_.scale_pixels[choice.scale] == 0;
    const double merit = std::min(merit_left * choice.merit, choice.next_merit);
    const double stop = std::max(std::sqrt(merit * scale.psf_peak / scale.bias), point ? options.threshold_jy : 0);
    thin(choice.residual, options_.scale_pixels[choice.scale], options_.threads);
    // A smooth residual has more bright pixels than fit a cache; yet to choose them anew, all being blurred again, costs more.
    ActivePixels active(choice.residual, stop, scale.core, point ? ActivePixels::fit_a_cache : choice.residual.pixel.size());
    choice.residual = {};
    const auto before = static_cast<std::ptrdiff_t>(report.components.size());
    find_among(
        active,
        {.gain = options.gain, .stop_jy = stop, .scale = static_cast<int>(choice.scale), .flux_per_jy = 1 / scale.psf_peak},
        watch, report);
    ComponentModel found(residual.width, residual.height, options_.scale_pixels);
    found.add({report.components.begin() + before, report.components.end()});
    subtract(convolution_(found.image(options_.threads)), left);
    peak = peak_of(left);
  }
  return report;
}

}  // namespace misfit::imager
