#include "imager/clean/multiscale.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "imager/clean/active_pixels.h"
#include "imager/clean/components.h"
#include "imager/clean/gaussian_blur.h"
#include "imager/clean/mask.h"
#include "imager/clean/scale_places.h"
#include "imager/data/noise.h"

namespace misfit::imager {
namespace {

Image divided(Image image, double by) {
  for (double& pixel : image.pixel) pixel /= by;
  return image;
}

}  // namespace

Multiscale::Multiscale(const Image& psf, const MultiscaleOptions& options)
    : MinorCycle(psf), options_(options), convolution_(psf, options.threads) {
  check_scales(options);
  const double largest = options.scale_pixels.back();
  for (const double scale : options.scale_pixels) {
    const Image twice = scale == 0 ? psf : gaussian_blur(psf, std::sqrt(2.0) * scale, options.threads);
    const double peak = twice.at(psf.height / 2, psf.width / 2);
    scale_.push_back({largest == 0 ? 1 : 1 - options.small_scale_bias * scale / largest, peak, PsfCore(divided(twice, peak))});
  }
}

Multiscale::Choice Multiscale::choose(const Image& left, const ScalePlaces& places) const {
  Choice best;
  for (std::size_t s = 0; s < scale_.size(); ++s) {
    Image residual = blurred(left, options_.scale_pixels[s], options_.threads);
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

MinorCycleReport Multiscale::find(const std::vector<const Image*>& residuals, const MinorCycleOptions& options) const {
  const Image& residual = *residuals.front();
  constexpr double merit_left = 0.5;
  constexpr double least_merit = 0.01;  // of a point's at the threshold: no scale sees what is left
  const ScalePlaces allowed = scale_places(residual, options.mask, options_);
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
