#include "imager/clean/joint_clean.h"

#include <algorithm>
#include <cmath>

#include "imager/clean/bright_places.h"
#include "imager/clean/brightness.h"
#include "imager/clean/components.h"
#include "imager/clean/finite_images.h"

namespace misfit::imager {
namespace {

/// The bright places, all from a level on, and the components found among them.
struct InView {
  BrightPlaces& bright;
  double level;
  double unit_jy;

  /// True if no point of the list exceeds `jy`, and those outside it did not when it was made.
  bool points_are_below(double jy) const { return level <= jy / unit_jy && bright.point_brightness() <= jy / unit_jy; }
};

/// Finds components among bright places until points have reached their depth, or no place is brighter than `lowest`, or other
/// places may have become as bright.
void find_among(const InView& view, const ScaledPsf& psf, const MinorCycleOptions& o, double lowest, MinorCycleWatch& watch,
                MinorCycleReport& report) {
  constexpr double bearable = 0.2;
  BrightPlaces& bright = view.bright;
  const double first = bright.brightness();
  const auto is_deep_enough = [&] {
    if (!view.points_are_below(watch.depth_jy())) return false;
    return !watch.is_to_the_last() || !bright.subtract_outstanding() || view.points_are_below(watch.depth_jy());
  };
  do {
    const BrightPlaces::Place at = bright.brightest();
    const ScaledPsf::Scale& scale = psf.scales()[at.scale];
    TaylorValues y = scale.basis.coordinates(at.residual);
    for (double& of_term : y) of_term *= o.gain;
    const TaylorValues coefficient = scale.basis.coefficients(y);
    Component component{scale.looked_at.index, at.row, at.column, coefficient.front() * view.unit_jy};
    for (std::size_t t = 1; t < most_taylor_terms; ++t) component.further_jy[t - 1] = coefficient[t] * view.unit_jy;
    report.components.push_back(component);
    watch.add(component);
    bright.subtract(at, coefficient);
    if (bright.outstanding() > bearable * bright.brightness() && !bright.subtract_outstanding()) break;
  } while (!is_deep_enough() && bright.brightness() > std::max(lowest, bright.of_others()) &&
           bright.brightness() <= minor_cycle_divergence * first && !watch.is_at_limit(report));
}

const MultiscaleOptions& checked(const std::vector<const Image*>& psf, const MultiscaleOptions& options) {
  check_scales(options);
  for (const Image* image : psf) require_finite_psf(*image);
  return options;
}

}  // namespace

JointClean::JointClean(const std::vector<const Image*>& psf, const MultiscaleOptions& options)
    : MinorCycle(*psf.front(), static_cast<int>(psf.size() + 1) / 2),
      options_(checked(psf, options)),
      psf_(psf, options),
      fft_(psf, psf_.looked_at(), options.threads) {}

MinorCycleReport JointClean::find(const std::vector<const Image*>& residual, const MinorCycleOptions& o) const {
  constexpr double as_good_as = 1.005;  // a convolution costs as much for the last pixels as for the first
  constexpr double deep = 3;            // places are looked at from this part of the threshold on
  constexpr double least_merit = 0.01;  // of a point's at the threshold: no scale sees what is left
  constexpr std::size_t least_places = 65536;
  const std::size_t most = std::max(least_places, residual.front()->pixel.size() / (64 * residual.size()));
  const bool points = psf_.scales().front().looked_at.index >= 0;
  ScaledResidual left(residual, o.mask, psf_, fft_, options_.threads);
  const double unit = left.unit_jy();
  MinorCycleReport report;
  Brightness now = brightness_of(left, psf_, options_.threads);
  MinorCycleWatch watch(o, width(), height(), now.points * unit);
  while (!watch.ends(now.points * unit, report)) {
    if (report.iterations() > 0 && now.points * unit <= as_good_as * watch.depth_jy()) {
      report.end = MinorCycleEnd::threshold;
      break;
    }
    const double threshold = watch.least_depth_jy() / unit;
    if (!(now.brightest * now.brightest > least_merit * threshold * threshold)) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    // Without points to put there may be no place as bright as the brightest point.
    const double target = points ? threshold : std::min(threshold, now.brightest / 2);
    const double level = level_for(left, psf_, target / deep, now.brightest, most, options_.threads);
    const auto before = static_cast<std::ptrdiff_t>(report.components.size());
    BrightPlaces bright(left, psf_, level, options_.threads);
    if (bright.brightness() == 0) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    const InView view{bright, level, unit};
    find_among(view, psf_, o, points ? level : std::max(level, target), watch, report);
    if (view.points_are_below(watch.depth_jy()) && !watch.may_go_deeper() &&
        (!watch.is_to_the_last() || bright.sees_all_above(watch.depth_jy() / unit))) {
      report.peak_jy = bright.point_brightness() * unit;
      report.end = MinorCycleEnd::threshold;
      break;
    }
    ComponentModel found(width(), height(), options_.scale_pixels);
    found.add({report.components.begin() + before, report.components.end()});
    left.subtract(found);
    if (watch.follows_noise()) watch.see_noise(left.noise_jy());
    now = brightness_of(left, psf_, options_.threads);
  }
  const bool cut = report.end == MinorCycleEnd::iterations || report.end == MinorCycleEnd::stopped;
  report.noise_jy = watch.noise_jy();
  report.depth_jy = cut ? std::max(watch.depth_jy(), report.peak_jy) : watch.depth_jy();
  return report;
}

}  // namespace misfit::imager
