#pragma once

#include "imager/data/geometry.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// How far samples reach at most, in wavelengths. A bound, known before the data are read.
struct UvwReach {
  double max_abs_u = 0;
  double max_abs_v = 0;
  double max_abs_w = 0;
};

/// How w is spread over usable samples; gathered while they stream by.
struct WSpread {
  double weight = 0;             ///< Σ weight
  double weighted_w_square = 0;  ///< Σ weight · w², w in wavelengths

  void add(const VisibilityBlock& block);
  WSpread& operator+=(const WSpread& other);

 private:
  void add_rows(const VisibilityBlock& block);
};

/// The phase 2πw(n−1) that a transform in two dimensions neglects.
struct NeglectedPhase {
  double max_rad = 0;  ///< largest |w| at the image's farthest corner; beyond the horizon counts as n = 0
  double rms_rad = 0;  ///< over samples (by weight) and pixels
};

/// The largest neglected phase, known before the data are read; |w| in wavelengths.
double max_w_phase_rad(double max_abs_w, const ImageGeometry& geometry);
NeglectedPhase neglected_w_phase(const UvwReach& reach, const WSpread& spread, const ImageGeometry& geometry);

}  // namespace misfit::imager
