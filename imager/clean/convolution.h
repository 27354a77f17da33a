#pragma once

#include <complex>
#include <functional>

#include "imager/data/image.h"
#include "imager/numerics/big_array.h"
#include "imager/numerics/fft.h"

namespace misfit::imager {

/// Convolution with a PSF of the images' size whose peak is the middle pixel: Σ_p image(p) psf(x − p). What lies beyond the PSF
/// counts as 0, as does NaN in either. By FFTs long enough that nothing wraps; `Real`, float or double, is their precision.
template <typename Real>
class Convolution {
 public:
  Convolution(const Image& psf, int threads);
  Image operator()(const Image& image) const;

  /// The same of an image that is read and written by rows: by several threads, each row once. Pixels to be read are 0 before;
  /// none may be NaN. All are read before any is written, and what is written may be changed.
  using Read = std::function<void(int row, Real* pixels)>;
  using Write = std::function<void(int row, Real* pixels)>;
  void operator()(const Read& read, const Write& write) const;

 private:
  using Complex = std::complex<Real>;

  void transform_rows(const Read& read, Complex* plane) const;
  void transform_psf_columns(const Complex* plane);
  void convolve_columns(Complex* plane) const;
  void transform_back_rows(const Complex* plane, const Write& write) const;

  int width_;
  int height_;
  int threads_;
  int nu_;  ///< lengths of the FFTs
  int nv_;
  std::ptrdiff_t columns_;  ///< from a row of a plane [height][nu/2 + 1] to the next
  Fft<Real> along_u_;
  Fft<Real> along_v_;
  BigArray<Complex> psf_;  ///< its transform / (nu · nv), [nu/2 + 1][nv]
};

}  // namespace misfit::imager
