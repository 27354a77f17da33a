#pragma once

#include "imager/data/image.h"

namespace misfit::imager {

/// Parameters of a mask made from residuals, with the names, meaning and defaults of CASA tclean's auto-multithresh.
struct AutoMaskOptions {
  double sidelobe_threshold = 3;     ///< new regions exceed this × largest sidelobe × peak …
  double noise_threshold = 5;        ///< … and this × noise
  double low_noise_threshold = 1.5;  ///< regions grow into what exceeds this × noise, and the sidelobes' threshold
  double min_beam_fraction = 0.3;    ///< regions of a smaller part of the beam's area are dropped
  int grow_iterations = 75;          ///< pixels that a region grows by at most
};

/// What the thresholds are relative to.
struct AutoMaskScene {
  double max_sidelobe = 0;      ///< of the PSF
  double noise_jy = 0;          ///< of the residual
  double beam_fwhm_pixels = 0;  ///< of a round beam of the same area
  int threads = 1;
};

/// Adds to `mask`, of the residual's size (1 = CLEAN may take components, 0 = not), what a residual shows (Kepley et al. 2020,
/// PASP 132, 024505): pixels above the upper threshold, less the regions that are too small, spread by a beam; and what was
/// there before, grown into neighbours above the lower threshold. Positive pixels only, NaN never.
void extend_mask(const Image& residual, const AutoMaskOptions& options, const AutoMaskScene& scene, Image& mask);

}  // namespace misfit::imager
