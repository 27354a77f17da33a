#pragma once

#include <cstddef>

#include "imager/beams/beam.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// Parameters of a mask made from residuals, with the names, meaning and defaults of CASA tclean's auto-multithresh.
struct AutoMaskOptions {
  double sidelobe_threshold = 3;     ///< new regions exceed this × largest sidelobe × peak …
  double noise_threshold = 5;        ///< … and this × noise
  double low_noise_threshold = 1.5;  ///< regions grow into pixels that exceed this × noise, and the sidelobes' threshold
  double negative_threshold = 0;     ///< absorption is below −this × noise, and the sidelobes' threshold; 0: there is none
  double smooth_factor = 1;          ///< regions are smoothed by a beam wider by this factor; 0: they are not …
  double cut_threshold = 0.01;       ///< … and cut at this part of the smoothed region's largest value
  double min_beam_fraction = 0.3;    ///< regions of a smaller part of the beam's area are dropped
  int grow_iterations = 75;          ///< pixels that a region grows by at most
  bool grow_prune = true;            ///< whether small regions of the grown mask are dropped too
  double min_percent_change = -1;  ///< a mask by noise that grows by less, once CLEAN is at its depth, is final; −1: none is
  bool fast_noise = true;          ///< noise is taken from all pixels; else see mask_noise()
};

/// The quantities that thresholds are relative to.
struct AutoMaskScene {
  double max_sidelobe = 0;        ///< of the PSF
  double noise_jy = 0;            ///< of the residual
  Beam beam;                      ///< its main lobe
  double cell_rad = 0;            ///< pixel size
  const Image* within = nullptr;  ///< where masks may be, see mask_allows(); null = everywhere
  int threads = 1;
};

/// A mask that grows from residual to residual.
struct GrowingMask {
  Image allowed;       ///< 1: CLEAN may take components, 0: not
  Image negative;      ///< the part that absorption alone made, which does not grow; empty where absorption is not masked
  bool final = false;  ///< whether it stays as it is
};

/// How a mask came to be extended.
struct MaskExtension {
  double threshold_jy = 0;    ///< of new regions
  bool by_sidelobes = false;  ///< rather than noise
  int regions = 0;            ///< above it
  int pruned = 0;             ///< of these regions
  int grown_regions = 0;      ///< in the grown mask
  int grown_pruned = 0;       ///< of these regions
  std::size_t negative = 0;   ///< pixels below the negative threshold
  std::size_t added = 0;      ///< pixels that were not in the mask before
};

/// Extends the mask, of the residual's size, by a residual (Kepley et al. 2020, PASP 132, 024505, and tclean's documentation).
/// It adds pixels above the upper threshold, less regions that are too small, smoothed and cut; the mask of before, grown into
/// neighbours above the lower threshold but no farther, pruned, smoothed and cut likewise; and pixels below the negative
/// threshold, smoothed and cut. Regions hang together by their sides, not by their corners. NaN is never in it.
MaskExtension extend_mask(const Image& residual, const AutoMaskOptions& options, const AutoMaskScene& scene, GrowingMask& mask);

/// The noise as in tclean where fastnoise is false, of pixels within `within`, or of all where that is null or allows none:
/// 1.4826 × the median absolute deviation from the median, of the pixels outside the mask. Where the mask is empty, or holds
/// all of them, Chauvenet's criterion leaves pixels out instead, as often as it finds any: those farther from the mean than one
/// of so many would be in half of all draws.
double mask_noise(const Image& residual, const Image& mask, const Image* within, int threads);

}  // namespace misfit::imager
