#include "imager/hogbom.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/tiled_psf.h"
#include "imager/tiled_residual.h"

namespace misfit::imager {

MinorCycleReport hogbom(const Image& residual, const Image& psf, const MinorCycleOptions& options, Image& model) {
  if (residual.width != psf.width || residual.height != psf.height || residual.width != model.width ||
      residual.height != model.height)
    throw std::invalid_argument("residual of " + std::to_string(residual.width) + " × " + std::to_string(residual.height) +
                                " pixels: PSF and model are expected to have the same size");
  constexpr double divergence = 3;  // as clean() judges major cycles
  const TiledPsf tiled_psf(psf, options.threads);
  TiledResidual left(residual, tiled_psf, options.threads);
  Peak peak = left.peak();
  const double first_peak = std::abs(peak.value);
  MinorCycleReport report;
  const auto go_on = [&] {
    report.peak_jy = std::abs(peak.value);
    const bool stopped = options.stop_requested && report.iterations % 64 == 0 && options.stop_requested();
    return !stopped && report.iterations < options.max_iterations && report.peak_jy > options.threshold_jy &&
           report.peak_jy <= divergence * first_peak;
  };
  while (go_on()) {
    const double component = options.gain * peak.value;
    model.at(peak.row, peak.column) += component;
    report.flux_jy += component;
    ++report.iterations;
    left.subtract(peak.row, peak.column, static_cast<float>(component));
    peak = left.peak();
  }
  return report;
}

}  // namespace misfit::imager
