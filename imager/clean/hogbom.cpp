#include "imager/clean/hogbom.h"

#include <cmath>

#include "imager/clean/mask.h"
#include "imager/clean/tiled_residual.h"

namespace misfit::imager {

Hogbom::Hogbom(const Image& psf, int threads) : MinorCycle(psf), psf_(psf, threads), threads_(threads) {}

MinorCycleReport Hogbom::find(const std::vector<const Image*>& residuals, const MinorCycleOptions& options) const {
  const Image& residual = *residuals.front();
  const Image cleanable = options.mask == nullptr ? Image() : masked(residual, *options.mask);
  TiledResidual left(options.mask == nullptr ? residual : cleanable, psf_, threads_);
  Peak peak = left.peak();
  const MinorCycleWatch watch(options, std::abs(peak.value));
  MinorCycleReport report;
  while (!watch.ends(std::abs(peak.value), report)) {
    const double component = options.gain * peak.value;
    report.components.push_back({0, peak.row, peak.column, component});
    left.subtract(peak.row, peak.column, static_cast<float>(component));
    peak = left.peak();
  }
  return report;
}

}  // namespace misfit::imager
