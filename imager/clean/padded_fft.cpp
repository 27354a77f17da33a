#include "imager/clean/padded_fft.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr int line_bytes = 64;

/// Room for the image, and for the half of the PSF that reaches beyond an edge.
int length(int pixels, int multiple) {
  const int needed = pixels + pixels / 2;
  return multiple * fast_fft_size((needed + multiple - 1) / multiple);
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

constexpr int rows_together = 16;

/// Columns in memory of their own, as many as share a cache line of a plane.
template <typename Real>
class Columns {
 public:
  using Complex = std::complex<Real>;
  static constexpr int most = line_bytes / sizeof(Complex);

  Columns(const Fft<Real>& fft, int count) : count_(count) {
    for (int c = 0; c < count; ++c) column_[c] = fft.complex_buffer();
  }
  Complex* operator[](int c) const { return column_[c].get(); }
  void read(const Complex* from, int row) const {
    for (int c = 0; c < count_; ++c) column_[c][static_cast<std::size_t>(row)] = from[c];
  }
  void write(int row, Complex* to) const {
    for (int c = 0; c < count_; ++c) to[c] = column_[c][static_cast<std::size_t>(row)];
  }

 private:
  int count_;
  typename Fft<Real>::ComplexBuffer column_[most];
};

/// The product by hand: operator* would look for infinities.
template <typename Real>
std::complex<Real> product(std::complex<Real> a, std::complex<Real> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

template <typename Real>
PaddedFft<Real>::PaddedFft(int width, int height, const std::vector<int>& steps, int threads)
    : width_(width), height_(height), threads_(threads) {
  const int multiple = std::max(1, *std::max_element(steps.begin(), steps.end()));
  nu_ = length(width, multiple);
  nv_ = length(height, multiple);
  plans_[1] = std::make_unique<Plans>(nu_, nv_);
  for (const int step : steps)
    if (plans_[step] == nullptr) plans_[step] = std::make_unique<Plans>(nu_ / step, nv_ / step);
}

template <typename Real>
std::ptrdiff_t PaddedFft<Real>::columns() const {
  return row_length(nu_ / 2 + 1, line_bytes / sizeof(Complex));
}

template <typename Real>
void PaddedFft<Real>::forward(const Read& read, Half& to) const {
  transform_rows(read, 0, to);
}

template <typename Real>
void PaddedFft<Real>::transform_rows(const Read& read, int first_column, Half& to) const {
  const Plans& plans = *plans_.at(1);
  to.reserve(static_cast<std::size_t>(height_ * columns()));
  in_pieces(height_, rows_together, threads_, [&](int begin, int end) {
    const auto pixels = plans.along_u.real_buffer();
    const auto spectrum = plans.along_u.complex_buffer();
    for (int r = begin; r < end; ++r) {
      std::fill_n(pixels.get(), nu_, Real(0));
      read(r, pixels.get());
      std::rotate(pixels.get(), pixels.get() + first_column, pixels.get() + nu_);
      plans.along_u.real_to_complex(pixels.get(), spectrum.get());
      std::copy_n(spectrum.get(), nu_ / 2 + 1, to.data() + r * columns());
    }
  });
}

template <typename Real>
void PaddedFft<Real>::forward_psf(const Read& read, Spectrum& to) const {
  const Fft<Real>& along_v = plans_.at(1)->along_v;
  const Real scale = static_cast<Real>(1 / (double(nu_) * nv_));
  Half half;
  transform_rows(read, width_ / 2, half);
  to.reserve(static_cast<std::size_t>(nu_ / 2 + 1) * static_cast<std::size_t>(nv_));
  in_pieces(nu_ / 2 + 1, Columns<Real>::most, threads_, [&](int begin, int end) {
    const Columns<Real> column(along_v, end - begin);
    for (int c = 0; c < end - begin; ++c) std::fill_n(column[c], nv_, Complex(0));
    for (int r = 0; r < height_; ++r)
      column.read(half.data() + r * columns() + begin, r < height_ / 2 ? r - height_ / 2 + nv_ : r - height_ / 2);
    for (int c = 0; c < end - begin; ++c) {
      along_v.complex_to_complex(column[c], Fft<Real>::Sign::forward);
      std::transform(column[c], column[c] + nv_, to.data() + static_cast<std::ptrdiff_t>(begin + c) * nv_,
                     [scale](Complex value) { return scale * value; });
    }
  });
}

template <typename Real>
void PaddedFft<Real>::backward(const std::vector<const Half*>& from, const Combine& combine, int step,
                               const Write& write) const {
  const Fft<Real>& forward_v = plans_.at(1)->along_v;
  const Plans& plans = *plans_.at(step);
  const int nu = nu_ / step, nv = nv_ / step, rows = (height_ + step - 1) / step;
  const int kept = step == 1 ? nu / 2 + 1 : nu / 2;  // at 1/(2 step) itself there is nothing
  const std::ptrdiff_t next_row = row_length(nu / 2 + 1, line_bytes / sizeof(Complex));
  Half plane;
  plane.reserve(static_cast<std::size_t>(rows * next_row));
  in_pieces(kept, Columns<Real>::most, threads_, [&](int begin, int end) {
    std::deque<Columns<Real>> input;
    for (const Half* half : from) {
      const Columns<Real>& column = input.emplace_back(forward_v, end - begin);
      for (int r = 0; r < height_; ++r) column.read(half->data() + r * columns() + begin, r);
    }
    const Columns<Real> output(plans.along_v, end - begin);
    const auto combined = forward_v.complex_buffer();
    for (int c = 0; c < end - begin; ++c) {
      std::vector<const Complex*> spectrum;
      for (const Columns<Real>& column : input) {
        std::fill(column[c] + height_, column[c] + nv_, Complex(0));
        forward_v.complex_to_complex(column[c], Fft<Real>::Sign::forward);
        spectrum.push_back(column[c]);
      }
      if (step == 1) {
        combine(begin + c, spectrum.data(), output[c]);
      } else {
        combine(begin + c, spectrum.data(), combined.get());
        std::copy_n(combined.get(), nv / 2, output[c]);
        std::copy_n(combined.get() + nv_ - nv / 2, nv / 2, output[c] + nv / 2);
        output[c][nv / 2] = 0;
      }
      plans.along_v.complex_to_complex(output[c], Fft<Real>::Sign::backward);
    }
    for (int r = 0; r < rows; ++r) output.write(r, plane.data() + r * next_row + begin);
  });
  in_pieces(rows, rows_together, threads_, [&](int begin, int end) {
    const auto spectrum = plans.along_u.complex_buffer();
    const auto pixels = plans.along_u.real_buffer();
    for (int r = begin; r < end; ++r) {
      std::copy_n(plane.data() + r * next_row, kept, spectrum.get());
      std::fill_n(spectrum.get() + kept, nu / 2 + 1 - kept, Complex(0));
      plans.along_u.complex_to_real(spectrum.get(), pixels.get());
      write(r, pixels.get());
    }
  });
}

template <typename Real>
void read_row(const Image& image, int row, Real* to) {
  std::transform(image.row(row), image.row(row) + image.width, to,
                 [](double value) { return std::isnan(value) ? Real(0) : static_cast<Real>(value); });
}
template void read_row<float>(const Image&, int, float*);
template void read_row<double>(const Image&, int, double*);

template <typename Real>
void set_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to) {
  for (int v = 0; v < count; ++v) to[v] = product(a[v], b[v]);
}
template void set_products<float>(const std::complex<float>*, const std::complex<float>*, int, std::complex<float>*);
template void set_products<double>(const std::complex<double>*, const std::complex<double>*, int, std::complex<double>*);

template <typename Real>
void add_products(const std::complex<Real>* a, const std::complex<Real>* b, int count, std::complex<Real>* to) {
  for (int v = 0; v < count; ++v) to[v] += product(a[v], b[v]);
}
template void add_products<float>(const std::complex<float>*, const std::complex<float>*, int, std::complex<float>*);
template void add_products<double>(const std::complex<double>*, const std::complex<double>*, int, std::complex<double>*);

template class PaddedFft<float>;
template class PaddedFft<double>;

}  // namespace misfit::imager
