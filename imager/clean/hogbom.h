#pragma once

#include <vector>

#include "imager/clean/minor_cycle.h"
#include "imager/clean/tiled_psf.h"

namespace misfit::imager {

/// Högbom's CLEAN (Högbom 1974, A&AS 15, 417): again and again the brightest pixel, positive or negative, gives `gain` times
/// its value to the model, and that times the PSF is subtracted from all pixels. Works on a single-precision copy of the
/// residual; see TiledResidual for how.
class Hogbom : public MinorCycle {
 public:
  Hogbom(const Image& psf, int threads);

  const std::vector<double>& scale_pixels() const override { return scale_pixels_; }

 private:
  MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const override;

  std::vector<double> scale_pixels_{0};
  TiledPsf psf_;
  int threads_;
};

}  // namespace misfit::imager
