#pragma once

#include "imager/half_grid.h"
#include "imager/image.h"

namespace misfit::imager {

/// Convolution with a PSF of the images' size whose peak is the middle pixel: Σ_p image(p) psf(x − p). What lies beyond the PSF
/// counts as 0, as does NaN in either. By FFTs long enough that nothing wraps; `Real`, float or double, is their precision.
template <typename Real>
class Convolution {
 public:
  Convolution(const Image& psf, int threads);
  Image operator()(const Image& image) const;

 private:
  HalfGrid<Real> transformed(const Image& image) const;

  GridShape shape_;
  ImageCorrection ones_;
  int threads_;
  HalfGrid<Real> psf_;
};

}  // namespace misfit::imager
