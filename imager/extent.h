#pragma once

#include "imager/geometry.h"
#include "imager/visibilities.h"

namespace misfit::imager {

/// How far usable samples reach, in wavelengths.
struct UvwExtent {
  double max_abs_u = 0;
  double max_abs_v = 0;
  double max_abs_w = 0;
  double weight = 0;             ///< Σ weight
  double weighted_w_square = 0;  ///< Σ weight · w²

  void add(const VisibilityBlock& block);
};

/// The phase 2πw(n−1) that a transform in two dimensions neglects.
struct NeglectedPhase {
  double max_rad = 0;  ///< largest |w| at the image's farthest corner; beyond the horizon counts as n = 0
  double rms_rad = 0;  ///< over samples (by weight) and pixels
};

NeglectedPhase neglected_w_phase(const UvwExtent& extent, const ImageGeometry& geometry);

}  // namespace misfit::imager
