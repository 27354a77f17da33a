#pragma once

#include "imager/clean/padded_fft.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// Convolution with a PSF of the images' size whose peak is the middle pixel: Σ_p image(p) psf(x − p). What lies beyond the PSF
/// counts as 0, as does NaN in either. By FFTs long enough that nothing wraps; `Real`, float or double, is their precision.
template <typename Real>
class Convolution {
 public:
  Convolution(const Image& psf, int threads);
  Image operator()(const Image& image) const;

 private:
  int width_;
  int height_;
  PaddedFft<Real> fft_;
  typename PaddedFft<Real>::Spectrum psf_;
};

/// Copies a row of an image, 0 in place of NaN.
template <typename Real>
void read_row(const Image& image, int row, Real* to);

/// to[v] = a[v] · b[v], or to[v] += that.
template <typename Real>
void set_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to);
template <typename Real>
void add_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to);

}  // namespace misfit::imager
