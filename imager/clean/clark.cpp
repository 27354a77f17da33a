#include "imager/clean/clark.h"

#include <cstddef>

#include "imager/clean/active_pixels.h"
#include "imager/clean/components.h"
#include "imager/clean/mask.h"
#include "imager/data/noise.h"

namespace misfit::imager {

Clark::Clark(const Image& psf, int threads) : MinorCycle(psf), core_(psf), convolution_(psf, threads), threads_(threads) {}

MinorCycleReport Clark::find(const std::vector<const Image*>& residuals, const MinorCycleOptions& options) const {
  const Image& residual = *residuals.front();
  MinorCycleReport report;
  Image left = options.mask == nullptr ? residual : masked(residual, *options.mask);
  double peak = largest_magnitude(left);
  const MinorCycleWatch watch(options, peak);
  while (!watch.ends(peak, report)) {
    ActivePixels active(left, options.threshold_jy, core_);
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
