#include "imager/clean/convolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace misfit::imager {

template <typename Real>
void read_row(const Image& image, int row, Real* to) {
  std::transform(image.row(row), image.row(row) + image.width, to,
                 [](double value) { return std::isnan(value) ? Real(0) : static_cast<Real>(value); });
}
template void read_row<float>(const Image&, int, float*);
template void read_row<double>(const Image&, int, double*);

namespace {

/// By hand: operator* would look for infinities.
template <typename Real>
std::complex<Real> product(std::complex<Real> a, std::complex<Real> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

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

template class Convolution<float>;
template class Convolution<double>;

}  // namespace misfit::imager
