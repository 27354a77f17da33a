#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>

#include "imager/clean/padded_fft.h"
#include "imager/data/image.h"

namespace misfit::imager::testing {

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

template <typename Real>
Convolution<Real>::Convolution(const Image& psf, int threads)
    : width_(psf.width), height_(psf.height), fft_(psf.width, psf.height, {1}, threads) {
  fft_.forward_psf([&](int row, Real* pixels) { read_row(psf, row, pixels); }, psf_);
}

template <typename Real>
Image Convolution<Real>::operator()(const Image& image) const {
  typename PaddedFft<Real>::Half half;
  fft_.forward([&](int row, Real* pixels) { read_row(image, row, pixels); }, half);
  Image convolved(width_, height_);
  fft_.backward(
      {&half},
      [&](int u, const std::complex<Real>* const* spectrum, std::complex<Real>* result) {
        set_products(spectrum[0], psf_.data() + static_cast<std::ptrdiff_t>(u) * fft_.nv(), fft_.nv(), result);
      },
      1, [&](int row, const Real* pixels) { std::copy_n(pixels, width_, convolved.row(row)); });
  return convolved;
}

}  // namespace misfit::imager::testing
