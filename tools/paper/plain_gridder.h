#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/image.h"
#include "imager/data/visibilities.h"
#include "kernels/piecewise_polynomial.h"

namespace misfit::tools {

/// Gridding and FFT as they are defined, for taps of any origin, such as those that a lookup table gives.
struct PlainGridder {
  imager::ImageGeometry geometry;
  int fft_size = 0;            ///< of both axes, at least the image's
  kernels::TapFunction taps;   ///< of both axes
  Eigen::VectorXd correction;  ///< h at offsets of 0, 1 … pixels; at least half the image's longer side
};

/// Σ w Re[V exp(−2πi(ul+vm))] at every pixel, on one core in doubles; samples beyond 1/(2 cell) are left out. `visibility` is
/// [row][channel] and stands for the block's own.
imager::Image plain_image(const PlainGridder& gridder, const imager::VisibilityBlock& block,
                          const std::vector<std::complex<double>>& visibility);

/// V = Σ I exp(2πi(ul+vm)) of the model's pixels in Jy, [row][channel], by FFT and degridding: the adjoint of plain_image
/// without its weights, 0 where that leaves samples out.
std::vector<std::complex<double>> plain_prediction(const PlainGridder& gridder, const imager::Image& model,
                                                   const imager::VisibilityBlock& block);

}  // namespace misfit::tools
