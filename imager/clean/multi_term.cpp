#include "imager/clean/multi_term.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "imager/clean/components.h"
#include "imager/clean/mask.h"
#include "imager/data/noise.h"

namespace misfit::imager {
namespace {

std::vector<const Image*> pointers_to(const std::vector<Image>& images) {
  std::vector<const Image*> result;
  for (const Image& image : images) result.push_back(&image);
  return result;
}

TermCores cores_of(const std::vector<const Image*>& psf, double scale_pixels, int threads) {
  if (scale_pixels == 0) return {psf, threads};
  std::vector<Image> twice;
  for (const Image* image : psf) twice.push_back(blurred(*image, std::sqrt(2.0) * scale_pixels, threads));
  return {pointers_to(twice), threads};
}

}  // namespace

MultiTerm::MultiTerm(const std::vector<const Image*>& psf, const MultiscaleOptions& options)
    : MinorCycle(*psf.front(), static_cast<int>(psf.size() + 1) / 2), options_(options), point_(basis_of(psf)) {
  check_scales(options);
  const double largest = options.scale_pixels.back();
  for (const double scale : options.scale_pixels) {
    TermCores cores = cores_of(psf, scale, options.threads);
    const double peak = cores.basis.peak();
    scale_.push_back({largest == 0 ? 1 : 1 - options.small_scale_bias * scale / largest, peak, std::move(cores)});
  }
  for (const Image* image : psf) convolution_.push_back(std::make_unique<Convolution<float>>(*image, options.threads));
}

MultiTerm::Choice MultiTerm::choose(const std::vector<Image>& left, const ScalePlaces& places) const {
  Choice best;
  for (std::size_t s = 0; s < scale_.size(); ++s) {
    std::vector<Image> residual;
    for (const Image& image : left) residual.push_back(blurred(image, options_.scale_pixels[s], options_.threads));
    Image bright = brightness(scale_[s].cores.basis, pointers_to(residual), options_.threads);
    const double peak = peak_at(places[s], bright, options_.threads);
    const double merit = scale_[s].bias * peak * peak / scale_[s].psf_peak;
    if (merit <= best.merit) {
      best.next_merit = std::max(best.next_merit, merit);
      continue;
    }
    best = {s, merit, best.merit, std::move(residual), std::move(bright)};
  }
  return best;
}

void MultiTerm::find_of_scale(Choice choice, const MinorCycleOptions& options, const MinorCycleWatch& watch,
                              MinorCycleReport& report) const {
  constexpr double merit_left = 0.5;
  const Scale& scale = scale_[choice.scale];
  const double scale_pixels = options_.scale_pixels[choice.scale];
  const bool point = scale_pixels == 0;
  const double merit = std::min(merit_left * choice.merit, choice.next_merit);
  const double stop = std::max(std::sqrt(merit * scale.psf_peak / scale.bias), point ? options.threshold_jy : 0);
  thin(choice.brightness, scale_pixels, options_.threads);
  ActiveTerms active(choice.brightness, pointers_to(choice.residual), scale.cores, stop,
                     point ? ActivePixels::fit_a_cache : choice.brightness.pixel.size());
  choice = {};
  find_among(active, scale.cores,
             {.gain = options.gain, .stop_jy = stop, .scale = static_cast<int>(&scale - scale_.data()), .flux_per_jy = 1},
             watch, report);
}

void MultiTerm::subtract(const ComponentModel& found, std::vector<Image>& left) const {
  for (std::size_t t = 0; t < left.size(); ++t) {
    const Image model = found.image(options_.threads, static_cast<int>(t));
    for (std::size_t q = 0; q < left.size(); ++q) imager::subtract((*convolution_[q + t])(model), left[q]);
  }
}

MinorCycleReport MultiTerm::find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const {
  constexpr double least_merit = 0.01;  // as in Multiscale
  const ScalePlaces allowed = scale_places(*residual.front(), options.mask, options_);
  std::vector<Image> left;
  for (const Image* image : residual) left.push_back(*image);
  const auto peak_of = [&] {
    Image bright = brightness(point_, pointers_to(left), options_.threads);
    return largest_magnitude(options.mask == nullptr ? bright : masked(std::move(bright), *options.mask));
  };
  MinorCycleReport report;
  double peak = peak_of();
  const MinorCycleWatch watch(options, peak);
  while (!watch.ends(peak, report)) {
    Choice choice = choose(left, allowed);
    if (!(choice.merit > least_merit * options.threshold_jy * options.threshold_jy)) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    const auto before = static_cast<std::ptrdiff_t>(report.components.size());
    find_of_scale(std::move(choice), options, watch, report);
    ComponentModel found(width(), height(), options_.scale_pixels);
    found.add({report.components.begin() + before, report.components.end()});
    subtract(found, left);
    peak = peak_of();
  }
  return report;
}

}  // namespace misfit::imager
