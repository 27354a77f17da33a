#include "imager/clean/convolution.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr int line_bytes = 64;

/// Room for the image, and for the half of the PSF that reaches beyond an edge.
int length(int pixels) {
  return fast_fft_size(pixels + pixels / 2);
}

/// Room for so many values in an odd number of cache lines: rows that lie a power of two apart push each other out of the
/// cache.
std::ptrdiff_t row_length(int values, std::ptrdiff_t in_line) {
  return ((values + in_line - 1) / in_line | 1) * in_line;
}

/// Calls body(begin, end) for consecutive pieces of [0, count), shared among threads.
template <typename Body>
void in_pieces(int count, int together, int threads, const Body& body) {
  parallel_for(static_cast<std::size_t>((count + together - 1) / together), threads, [&](std::size_t piece) {
    const int begin = static_cast<int>(piece) * together;
    body(begin, std::min(begin + together, count));
  });
}

/// Columns in memory of their own, as many as share a cache line of a plane.
template <typename Real>
class Columns {
 public:
  static constexpr int most = line_bytes / sizeof(std::complex<Real>);

  explicit Columns(const Fft<Real>& fft) {
    for (auto& column : column_) column = fft.complex_buffer();
  }
  std::complex<Real>* operator[](int c) const { return column_[c].get(); }
  void read(int row, const std::complex<Real>* from, int count) {
    for (int c = 0; c < count; ++c) column_[c][static_cast<std::size_t>(row)] = from[c];
  }
  void write(int row, std::complex<Real>* to, int count) const {
    for (int c = 0; c < count; ++c) to[c] = column_[c][static_cast<std::size_t>(row)];
  }

 private:
  typename Fft<Real>::ComplexBuffer column_[most];
};

}  // namespace

template <typename Real>
Convolution<Real>::Convolution(const Image& psf, int threads)
    : width_(psf.width),
      height_(psf.height),
      threads_(threads),
      nu_(length(psf.width)),
      nv_(length(psf.height)),
      columns_(row_length(nu_ / 2 + 1, line_bytes / sizeof(Complex))),
      along_u_(nu_),
      along_v_(nv_) {
  BigArray<Complex> plane;
  plane.reserve(static_cast<std::size_t>(height_ * columns_));
  const auto read = [&](int row, Real* pixels) {
    for (int c = 0; c < width_; ++c) {
      const double value = psf.at(row, c);
      pixels[c < width_ / 2 ? c - width_ / 2 + nu_ : c - width_ / 2] = std::isnan(value) ? Real(0) : static_cast<Real>(value);
    }
  };
  transform_rows(read, plane.data());
  psf_.reserve(static_cast<std::size_t>(nu_ / 2 + 1) * static_cast<std::size_t>(nv_));
  transform_psf_columns(plane.data());
}

template <typename Real>
Image Convolution<Real>::operator()(const Image& image) const {
  Image convolved(width_, height_);
  const auto read = [&](int row, Real* pixels) {
    std::transform(image.row(row), image.row(row) + width_, pixels,
                   [](double value) { return std::isnan(value) ? Real(0) : static_cast<Real>(value); });
  };
  (*this)(read, [&](int row, const Real* pixels) { std::copy_n(pixels, width_, convolved.row(row)); });
  return convolved;
}

template <typename Real>
void Convolution<Real>::operator()(const Read& read, const Write& write) const {
  BigArray<Complex> plane;
  plane.reserve(static_cast<std::size_t>(height_ * columns_));
  transform_rows(read, plane.data());
  convolve_columns(plane.data());
  transform_back_rows(plane.data(), write);
}

template <typename Real>
void Convolution<Real>::transform_rows(const Read& read, Complex* plane) const {
  constexpr int together = 16;
  in_pieces(height_, together, threads_, [&](int begin, int end) {
    const auto pixels = along_u_.real_buffer();
    const auto spectrum = along_u_.complex_buffer();
    for (int r = begin; r < end; ++r) {
      std::fill_n(pixels.get(), nu_, Real(0));
      read(r, pixels.get());
      along_u_.real_to_complex(pixels.get(), spectrum.get());
      std::copy_n(spectrum.get(), nu_ / 2 + 1, plane + r * columns_);
    }
  });
}

template <typename Real>
void Convolution<Real>::transform_psf_columns(const Complex* plane) {
  const Real scale = static_cast<Real>(1 / (double(nu_) * nv_));
  in_pieces(nu_ / 2 + 1, Columns<Real>::most, threads_, [&](int begin, int end) {
    Columns<Real> column(along_v_);
    for (int c = 0; c < end - begin; ++c) std::fill_n(column[c], nv_, Complex(0));
    for (int r = 0; r < height_; ++r)
      column.read(r < height_ / 2 ? r - height_ / 2 + nv_ : r - height_ / 2, plane + r * columns_ + begin, end - begin);
    for (int c = 0; c < end - begin; ++c) {
      along_v_.complex_to_complex(column[c], Fft<Real>::Sign::forward);
      std::transform(column[c], column[c] + nv_, psf_.data() + static_cast<std::ptrdiff_t>(begin + c) * nv_,
                     [scale](Complex value) { return scale * value; });
    }
  });
}

/// There and back while a cache holds a column.
template <typename Real>
void Convolution<Real>::convolve_columns(Complex* plane) const {
  in_pieces(nu_ / 2 + 1, Columns<Real>::most, threads_, [&](int begin, int end) {
    Columns<Real> column(along_v_);
    for (int r = 0; r < height_; ++r) column.read(r, plane + r * columns_ + begin, end - begin);
    for (int c = 0; c < end - begin; ++c) {
      Complex* const value = column[c];
      const Complex* const psf = psf_.data() + static_cast<std::ptrdiff_t>(begin + c) * nv_;
      std::fill(value + height_, value + nv_, Complex(0));
      along_v_.complex_to_complex(value, Fft<Real>::Sign::forward);
      for (int k = 0; k < nv_; ++k)  // by hand: operator* would look for infinities
        value[k] = {value[k].real() * psf[k].real() - value[k].imag() * psf[k].imag(),
                    value[k].real() * psf[k].imag() + value[k].imag() * psf[k].real()};
      along_v_.complex_to_complex(value, Fft<Real>::Sign::backward);
    }
    for (int r = 0; r < height_; ++r) column.write(r, plane + r * columns_ + begin, end - begin);
  });
}

template <typename Real>
void Convolution<Real>::transform_back_rows(const Complex* plane, const Write& write) const {
  constexpr int together = 16;
  in_pieces(height_, together, threads_, [&](int begin, int end) {
    const auto spectrum = along_u_.complex_buffer();
    const auto pixels = along_u_.real_buffer();
    for (int r = begin; r < end; ++r) {
      std::copy_n(plane + r * columns_, nu_ / 2 + 1, spectrum.get());
      along_u_.complex_to_real(spectrum.get(), pixels.get());
      write(r, pixels.get());
    }
  });
}

template class Convolution<float>;
template class Convolution<double>;

}  // namespace misfit::imager
