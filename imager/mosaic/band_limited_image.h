#pragma once

#include <vector>

#include "imager/data/image.h"
#include "imager/files/sky_grid.h"
#include "kernels/polynomial_taps.h"

namespace misfit::imager {

/// A plane of pixels, continued to places between them by its spectrum:
///     f(x, y) = Σ_jk F_jk g(u_j) g(v_k) exp(2πi(u_j x + v_k y)),   F the DFT of the pixels, u and v in cycles a pixel,
/// where g is 1 up to 0.4, falls as a raised cosine to 0 at 0.6, and g(½ + t) + g(½ − t) = 1. A plane whose spectrum is 0
/// beyond 0.4 is interpolated exactly; a Gaussian four pixels wide has 2e-5 of it beyond 0.4, one three pixels wide 1e-3.
/// Pixels keep their values in any case. Evaluated by degridding: F is divided by the taper of a least-misfit function of 8
/// cells and transformed to twice as many pixels, and 8 × 8 of these make a value, right to 1.3e-7 of the plane (RMS). Up to 37
/// bytes a pixel while it is made, 17 afterwards.
class BandLimitedImage {
 public:
  /// Values are undefined within so many pixels of an unknown pixel, and of the border: these count as 0, and any other number
  /// there would change the values by more than 1 % of it.
  static constexpr int margin = 8;

  /// `pixels` are all that are known, NaN elsewhere. `shown`, of the same size, is NaN where a known pixel only serves its
  /// neighbours, as one under a mask: nearest to it, values are undefined. The number of threads does not change a bit. Throws
  /// std::invalid_argument where the sizes differ.
  BandLimitedImage(const Image& pixels, const Image& shown, int threads);

  /// The value at a place; NaN where it is undefined, and where the place is.
  double at(const PixelPlace& place) const;

 private:
  void find_defined(const Image& pixels, const Image& shown, int threads);
  void refine(const Image& pixels, int threads);

  int width_;
  int height_;
  kernels::EvenOddPolynomial<double> taps_;
  std::vector<unsigned char> defined_;  ///< [row][column], of places nearest to a pixel
  std::vector<float> fine_;             ///< [2 height][2 width], on half pixels, without the taper
};

/// The image on other pixels, whose places in the image are map(row, column). NaN where `where`, which has their size, is NaN,
/// and where the image is undefined.
Image regridded(const BandLimitedImage& image, const GridMap& map, const Image& where, int threads);

}  // namespace misfit::imager
