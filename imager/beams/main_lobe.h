#pragma once

#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// The PSF at a point of its main lobe.
struct LobeSample {
  double east = 0;  ///< of the centre, in units of `MainLobe::scale` pixels
  double north = 0;
  double value = 0;
};

/// Where a PSF, with its centre at (row height/2, column width/2), is above 0.35 and connected to the centre.
struct MainLobe {
  static constexpr double cutoff = 0.35;  ///< CASA tclean's choice

  std::vector<LobeSample> samples;
  double scale = 1;  ///< radius in pixels of the circle of the same area
  int reach = 0;     ///< whole pixels from the centre to the farthest sample's row or column
};

/// The pixels of the main lobe. A lobe of fewer than 30 pixels is sampled 12 times as finely along each axis instead: a PSF has
/// no more than |u|, |v| ≤ ½ turn per pixel, so that
///   PSF(x, y) = Σ psf[r][c] sinc(x − c) sinc(y − r),  sinc(t) = sin(πt)/(πt),
/// and where all weights are positive it falls no faster than cos(π(|x| + |y|)), which leaves at least 41 samples. The sum ends
/// at W = 511 pixels from the centre or the image's border; NaN counts as 0. Ending it changes the contribution of a point of
/// the uv plane, along each axis, by at most 2 / (π (W + 1 − |x|) cos πu) of it: summation by parts. Where the finer lobe goes
/// on for 32 pixels, or out of the image, the samples are the pixels.
MainLobe main_lobe(const Image& psf);

}  // namespace misfit::imager
