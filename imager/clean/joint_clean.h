#pragma once

#include <vector>

#include "imager/clean/minor_cycle.h"
#include "imager/clean/scaled_psf.h"
#include "imager/clean/scaled_residual.h"

namespace misfit::imager {

/// CLEAN of points, or of Gaussians of several scales, with one or more Taylor terms. Again and again it looks for the place
/// and scale where a component takes most off χ², adds `gain` times the best fit there to the model, and subtracts it,
/// convolved with the PSF, everywhere.
///
/// With points and one term the next component lies in the brightest pixel, positive or negative (Högbom 1974, A&AS 15, 417).
/// With several scales (Cornwell 2008, IEEE J. Sel. Top. Signal Process. 2, 793) let R_s be the residual and P_ss the PSF's
/// peak when they are convolved with a scale's unit Gaussian once and twice. A component of flux R_s(x)/P_ss then takes
/// R_s(x)²/P_ss off χ²/Σw; this, times the scale's bias, is its merit. With n terms (Rau & Cornwell 2011, A&A 532, A71)
/// components have spectra. They are found in the residuals R_q of all terms with the 2n − 1 spectral PSFs P_k,
///
///     R_q = Σ_t P_{q+t} ⋆ I_t + noise,
///
/// where Rᵀ H⁻¹ R of TaylorBasis says how much the principal solution takes off χ². The principal solution's I_0 would be a
/// worse guide: with three terms over an even band its noise is half as large again as the noise of R_0.
///
/// Components are found among BrightPlaces alone, as Clark did (1980, A&A 89, 377): all places that have a third of the least
/// depth, or as many as are quickly looked at. When these are done, and other places may have become as bright, all components
/// are convolved with the PSF and taken off the whole residual, which shows whether any has. A Gaussian is put only where nine
/// tenths of it lie within the mask, and two of its widths within the image. It ends when the points' |y| of TaylorBasis, with
/// one term the residual's magnitude, reaches the depth of MinorCycleOptions.
class JointClean : public MinorCycle {
 public:
  /// Takes PSFs P_k [k], images of one size. Throws std::invalid_argument when there is no scale, one is not finite or
  /// negative, they do not ascend, or the bias is not in [0, 1); std::runtime_error when a PSF is not finite; and what
  /// TaylorBasis does.
  JointClean(const std::vector<const Image*>& psf, const MultiscaleOptions& options);

  const std::vector<double>& scale_pixels() const override { return options_.scale_pixels; }

 private:
  MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const override;

  MultiscaleOptions options_;
  ScaledPsf psf_;
  ScaledFft fft_;
};

}  // namespace misfit::imager
