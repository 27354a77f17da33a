#pragma once

#include "imager/data/geometry.h"

namespace misfit::imager {

/// A source of the sky: a circular Gaussian of flux S and full width at half maximum θ, or a point where θ = 0. Its visibility
/// is
///
///     V(u,v,w) = S exp(+2πi(ul + vm + w(n−1))) exp(−(πθ)² (u² + v²) / (4 ln 2)).
///
/// The Gaussian is one of the (l, m) plane, as the pixels of an image are: it is what an image with the brightness
/// S (4 ln 2 / (πθ²)) exp(−4 ln 2 ((l'−l)² + (m'−m)²) / θ²) dl' dm' in each pixel predicts without w. With w, n − 1 is taken at
/// the source's centre. Over the source it changes, which to first order moves (u, v) to (u − wl/n, v − wm/n) in the second
/// factor, and to second order changes V by about π|w|θ²/(4 ln 2) of itself: 0.03 % for 10″ at 10⁵ wavelengths, and 100 times
/// that for ten times the width. Where this matters, the source belongs into an image.
///
/// S may depend on the frequency: S(ν) = S(ν_0) (ν/ν_0)^α.
struct Source {
  DirectionCosines position;  ///< relative to the phase centre
  double flux_jy = 0;
  double fwhm_rad = 0;        ///< never negative
  double spectral_index = 0;  ///< α
  double reference_hz = 0;    ///< ν_0, the frequency of flux_jy; of no matter where α is 0
};

}  // namespace misfit::imager
