#pragma once

#include <cstddef>

#include "imager/clean/scaled_psf.h"
#include "imager/clean/scaled_residual.h"

namespace misfit::imager {

/// The brightness of the places of a residual, as BrightPlaces defines it.
struct Brightness {
  double points = 0;     ///< of the brightest point
  double brightest = 0;  ///< of the best place for a component
};
Brightness brightness_of(const ScaledResidual& residual, const ScaledPsf& psf, int threads);

/// The lowest brightness, from `lowest` on, that no more than `most` places exceed; `highest` is the brightest place's. Right
/// to a 4096th of highest − lowest.
double level_for(const ScaledResidual& residual, const ScaledPsf& psf, double lowest, double highest, std::size_t most,
                 int threads);

}  // namespace misfit::imager
