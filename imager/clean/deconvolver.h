#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/clean/minor_cycle.h"

namespace misfit::imager {

/// Full width at half maximum over radius of tclean's scales, (1 − r²) × spheroidal function (Schwab's, m = 6, α = 1).
inline constexpr double tclean_scale_width = 0.7412;

/// A minor cycle by name.
struct DeconvolverChoice {
  std::string name = "hogbom";          ///< one of deconvolver_names()
  std::vector<double> scale_pixels{0};  ///< of multiscale, see MultiscaleOptions
  double small_scale_bias = 0;          ///< of multiscale
  int threads = 1;
};

std::vector<std::string> deconvolver_names();

/// Makes the minor cycle of a PSF, or of the spectral PSFs P_k [k] of several Taylor terms. Throws std::invalid_argument when
/// there is none of that name, or it refuses the scales.
std::unique_ptr<MinorCycle> make_deconvolver(const DeconvolverChoice& choice, const std::vector<const Image*>& psf);

}  // namespace misfit::imager
