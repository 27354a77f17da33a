#pragma once

#include <vector>

#include "imager/clean/convolution.h"
#include "imager/clean/minor_cycle.h"
#include "imager/clean/psf_core.h"
#include "imager/clean/scale_places.h"

namespace misfit::imager {

/// Multiscale CLEAN (Cornwell 2008, IEEE J. Sel. Top. Signal Process. 2, 793): components are Gaussians of several widths. With
/// R_s the residual and P_ss the PSF's peak when they are convolved with the scale's unit Gaussian once and twice, a component
/// at x of flux R_s(x)/P_ss takes R_s(x)²/P_ss off what the residual could lose; the scale for which that, times the bias, is
/// largest comes next. Components of that scale are found as Clark's are, on every fifth part of the scale's width, until its
/// merit has halved and fallen below that of the next best scale; then all scales are compared anew. A Gaussian is put only
/// where nine tenths of it lie within the mask, and two of its widths within the image. Ends when `residual` itself, not its
/// convolutions, reaches the threshold.
class Multiscale : public MinorCycle {
 public:
  /// Throws std::invalid_argument when there is no scale, one is not finite or negative, they do not ascend, or the bias is not
  /// in [0, 1).
  Multiscale(const Image& psf, const MultiscaleOptions& options);

  const std::vector<double>& scale_pixels() const override { return options_.scale_pixels; }

 private:
  MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const override;

  struct Scale {
    double bias;
    double psf_peak;  ///< P_ss
    PsfCore core;     ///< of the PSF convolved twice, over its peak
  };
  /// The scale of largest merit.
  struct Choice {
    std::size_t scale = 0;
    double merit = 0;
    double next_merit = 0;  ///< of the best of the others
    Image residual;         ///< convolved with it, NaN where it may not be put
  };
  Choice choose(const Image& left, const ScalePlaces& places) const;

  MultiscaleOptions options_;
  std::vector<Scale> scale_;
  Convolution<float> convolution_;
};

}  // namespace misfit::imager
