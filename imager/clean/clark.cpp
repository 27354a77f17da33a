#include "imager/clean/clark.h"

#include <algorithm>
#include <cmath>

#include "imager/clean/active_pixels.h"
#include "imager/clean/components.h"
#include "imager/clean/mask.h"
#include "imager/noise.h"

namespace misfit::imager {
namespace {

constexpr int largest_core_reach = 512;
constexpr double lowest_part = 0.5;  // of the threshold: fainter pixels hardly rise above it before all are renewed

}  // namespace

Clark::Clark(const Image& psf, int threads)
    : MinorCycle(psf), core_(psf, largest_core_reach), convolution_(psf, threads), threads_(threads) {}

MinorCycleReport Clark::clean(const Image& residual, const MinorCycleOptions& options) const {
  require_size(residual, options);
  MinorCycleReport report;
  ComponentModel model(residual.width, residual.height, scale_pixels_);
  Image left = options.mask == nullptr ? residual : masked(residual, *options.mask);
  double peak = largest_magnitude(left);
  const MinorCycleWatch watch(options, peak);
  while (!watch.ends(peak, report)) {
    ActivePixels active(left, std::max(lowest_part * options.threshold_jy, core_.largest_outside() * peak), core_);
    const auto before = static_cast<std::ptrdiff_t>(report.components.size());
    find_among(active, {.gain = options.gain, .stop_jy = options.threshold_jy}, watch, report);
    ComponentModel found(residual.width, residual.height, scale_pixels_);
    found.add({report.components.begin() + before, report.components.end()});
    subtract(convolution_(found.image(threads_)), left);
    peak = largest_magnitude(left);
  }
  return report;
}

}  // namespace misfit::imager
