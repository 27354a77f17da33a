#pragma once

#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "imager/data/image.h"
#include "imager/numerics/big_array.h"
#include "imager/numerics/fft.h"

namespace misfit::imager {

/// FFTs of images, padded so that nothing wraps when they are multiplied with the FFT of a PSF of their size whose peak is its
/// middle pixel. `Real`, float or double, is their precision.
template <typename Real>
class PaddedFft {
 public:
  using Complex = std::complex<Real>;
  using Half = BigArray<Complex>;      ///< transformed along rows: [row of the image][u of columns()], u = 0 … nu/2
  using Spectrum = BigArray<Complex>;  ///< [u][v], v = 0 … nv − 1
  /// Pixels of a row of the image, which are 0 before.
  using Read = std::function<void(int row, Real* pixels)>;
  /// Pixels of a row, or every step-th pixel of every step-th row, with rows counted accordingly; they may be changed.
  using Write = std::function<void(int row, Real* pixels)>;
  /// Combines the spectra of images [image][v] at one u into another's.
  using Combine = std::function<void(int u, const Complex* const* spectrum, Complex* result)>;

  /// `steps`, powers of two, are those of backward().
  PaddedFft(int width, int height, const std::vector<int>& steps, int threads);

  int nu() const { return nu_; }
  int nv() const { return nv_; }

  /// The first half of the transform of an image whose pixel (0, 0) is the origin. Rows are read by several threads, each once.
  void forward(const Read& read, Half& to) const;
  /// The whole transform of a PSF over nu · nv: its middle pixel is the origin.
  void forward_psf(const Read& read, Spectrum& to) const;
  /// Makes an image of a spectrum combined from others, at every step-th pixel of every step-th row: the spectrum must be as
  /// good as 0 beyond 1/(2 step). Spectra are combined, and rows written, by several threads, each once; a cache holds the
  /// spectra.
  void backward(const std::vector<const Half*>& from, const Combine& combine, int step, const Write& write) const;

 private:
  struct Plans {
    Plans(int nu, int nv) : along_u(nu), along_v(nv) {}
    Fft<Real> along_u;
    Fft<Real> along_v;
  };
  void transform_rows(const Read& read, int first_column, Half& to) const;
  std::ptrdiff_t columns() const;  ///< from a row of a Half to the next

  int width_;
  int height_;
  int threads_;
  int nu_;
  int nv_;
  std::map<int, std::unique_ptr<Plans>> plans_;  ///< by step
};

/// Copies a row of an image, 0 in place of NaN.
template <typename Real>
void read_row(const Image& image, int row, Real* to);

/// to[v] = a[v] · b[v], or to[v] += a[v] · b[v].
template <typename Real>
void set_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to);
template <typename Real>
void add_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to);

}  // namespace misfit::imager
