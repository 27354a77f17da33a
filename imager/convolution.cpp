#include "imager/convolution.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "imager/fft.h"
#include "imager/parallel.h"

namespace misfit::imager {
namespace {

/// Room for the image, and for half of the PSF beyond either of its edges.
int length(int pixels) {
  return fast_fft_size(pixels + pixels / 2 + 1);
}

GridShape shape_for(int width, int height) {
  constexpr int any_tile = 32;
  return {length(width), length(height), 0, any_tile};
}

}  // namespace

template <typename Real>
Convolution<Real>::Convolution(const Image& psf, int threads)
    : shape_(shape_for(psf.width, psf.height)),
      ones_{std::vector<double>(static_cast<std::size_t>(psf.width), 1),
            std::vector<double>(static_cast<std::size_t>(psf.height), 1)},
      threads_(threads),
      psf_(transformed(psf)) {}

template <typename Real>
HalfGrid<Real> Convolution<Real>::transformed(const Image& image) const {
  HalfGrid<Real> grid(shape_, false);
  const auto is_nan = [](double x) { return std::isnan(x); };
  if (std::none_of(image.pixel.begin(), image.pixel.end(), is_nan)) {
    image_to_grid(image, ones_, threads_, grid);
  } else {
    Image finite = image;
    std::replace_if(finite.pixel.begin(), finite.pixel.end(), is_nan, 0.0);
    image_to_grid(finite, ones_, threads_, grid);
  }
  return grid;
}

template <typename Real>
Image Convolution<Real>::operator()(const Image& image) const {
  HalfGrid<Real> grid = transformed(image);
  const auto columns = static_cast<std::size_t>(shape_.columns()), nu = static_cast<std::size_t>(shape_.nu);
  const auto q_end = static_cast<std::size_t>(shape_.nv / 2);
  const double scale = 1 / (double(shape_.nu) * shape_.nv);
  // A cell stands for another by conjugation too. Beyond nu columns and nv/2 rows cells repeat others, and become 0.
  parallel_for(static_cast<std::size_t>(shape_.rows()), threads_, [&](std::size_t q) {
    const double stands_for = q == 0 || q == q_end ? 1 : 2;
    const Real factor = q > q_end ? Real(0) : static_cast<Real>(stands_for * scale);
    for (std::size_t i = q * columns; i < (q + 1) * columns; ++i) {
      const Real f = i < q * columns + nu ? factor : Real(0);
      const Real re = grid.real[i], im = grid.imaginary[i];
      grid.real[i] = f * (re * psf_.real[i] - im * psf_.imaginary[i]);
      grid.imaginary[i] = f * (re * psf_.imaginary[i] + im * psf_.real[i]);
    }
  });
  return grid_to_image(shape_, std::move(grid.real), std::move(grid.imaginary), ones_, threads_);
}

template class Convolution<float>;
template class Convolution<double>;

}  // namespace misfit::imager
