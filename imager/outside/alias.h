#pragma once

#include <utility>
#include <vector>

#include "imager/outside/sidelobes.h"
#include "imager/plan/gridding_plan.h"
#include "imager/wide/facet.h"

namespace misfit::imager {

/// The errors that gridding makes of sources outside an image: the image less the exact one of the same data.
///
/// A kernel with the taper c and correction h turns the exact image D along each axis, x being the offset from the middle of a
/// facet over the size of the FFT, into
///   h(x) Σ_r C(r−ν) exp(2πi(r−ν)x) = Σ_n H_n(x) exp(2πinν),  H_n(x) = h(x) c(x+n),  n whole (Poisson),
/// so that the error of a source of 1 Jy at X is Σ_{n,m} [H_n(x) H_m(y) − δ_{n0} δ_{m0}] · PSF(x+n − X, y+m − Y): copies of the
/// source with all their sidelobes, and its own sidelobes times the error of the correction. The source's own true sidelobes
/// belong to the exact image too, and are no error.
///
/// A copy that falls upon the image shows there as a point; all other copies, such as those in the padding, show by their
/// sidelobes. Their levels are added in squares, as their phases are unrelated: the level of a pixel is
///   √(Σ_{n,m} [H_n(x) H_m(y) − δ]² · P²(distance)),
/// P being the highest sidelobe from that distance on. Terms far off are many and add up by Parseval's sum, since with the
/// map error ℓ (kernels/map_error.h) Σ_n H_n² = H_0 = 1 − ℓ: all of them together are 1 − (1−ℓ_u)(1−ℓ_v). Of N equal terms the
/// sum can exceed this √N times; that takes four of them, each with its highest sidelobe upon one pixel with one sign, to be
/// twice as high. A w axis blurs copies, since n − 1 differs at the source: their level without that is an upper bound. A w
/// axis also has an ℓ of its own, as tables and rounding do. Without a w axis the source's own sidelobes differ from the exact
/// ones by the phase 2πw(n−1) of the pixel, φ at most: they count 2 sin(φ/2) times.
class AliasLevels {
 public:
  /// The levels of sources within `field`, whose places are known to half a pixel of it.
  AliasLevels(const GriddingPlan& plan, const ImageGeometry& field, Sidelobes sidelobes);

  /// The largest pixel of the error, in Jy/beam, that a source of 1 Jy there leaves in any facet.
  double of(DirectionCosines source) const;

  /// One axis of a facet, cut into cells in which heights hardly change.
  struct Axis {
    Axis(const kernels::Kernel& kernel, int pixels, int fft_size, double farthest_pixels);

    double fft_size = 0;
    std::vector<std::pair<double, double>> cell;  ///< first and last pixel, from the middle one
    std::vector<double> missed;                   ///< [cell] ℓ
    int most = 0;                                 ///< |n| of heights
    std::vector<std::vector<double>> height;      ///< [most + n][cell] |H_n|
  };

 private:
  double of_facet(double offset_u, double offset_v) const;

  std::vector<Facet> facets_;
  Sidelobes sidelobes_;
  double place_pixels_;  ///< pixels of the image to which places are known
  Axis u_;
  Axis v_;
  double out_of_phase_;    ///< the largest relative error of a source's own sidelobes where w is left out
  double rounding_;        ///< taps are rounded alike wherever they are alike, which makes copies
  double missed_besides_;  ///< ℓ of all that does not depend on place: w, tables, rounding
};

}  // namespace misfit::imager
