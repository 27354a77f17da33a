#include "imager/mosaic/resolution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "imager/clean/padded_fft.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

using Matrix = Eigen::Matrix2d;

/// The covariance of a beam, rad², in (east, north).
Matrix covariance(const Beam& beam) {
  const Eigen::Vector2d major(std::sin(beam.position_angle_rad), std::cos(beam.position_angle_rad));
  const Eigen::Vector2d minor(-major.y(), major.x());
  const double per_square = 1 / (8 * std::log(2.0));
  return per_square * (beam.major_rad * beam.major_rad * major * major.transpose() +
                       beam.minor_rad * beam.minor_rad * minor * minor.transpose());
}

/// The covariance of the Gaussian between two beams, pixels², in (column, row).
Matrix between(const BeamChange& change, const SkyGrid& grid) {
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(covariance(change.to) - covariance(change.from));
  const Matrix gaussian = axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).asDiagonal() * axes.eigenvectors().transpose();
  const Matrix to_pixels = Matrix{{grid.step[0][0], grid.step[0][1]}, {grid.step[1][0], grid.step[1][1]}}.inverse();
  return to_pixels * gaussian * to_pixels.transpose();
}

/// A plane times a scale, convolved with a Gaussian of unit sum.
Image blurred(const PaddedFft<double>& fft, const PaddedFft<double>::Read& read, const Matrix& gaussian, const Image& like) {
  using Value = PaddedFft<double>::Complex;
  PaddedFft<double>::Half half;
  fft.forward(read, half);
  const int nu = fft.nu(), nv = fft.nv();
  const auto multiply = [&](int u, const Value* const* spectrum, Value* result) {
    const double fu = static_cast<double>(u) / nu;
    for (int v = 0; v < nv; ++v) {
      const double fv = static_cast<double>(v <= nv / 2 ? v : v - nv) / nv;
      const double exponent = gaussian(0, 0) * fu * fu + 2 * gaussian(0, 1) * fu * fv + gaussian(1, 1) * fv * fv;
      result[v] = spectrum[0][v] * (std::exp(-2 * pi * pi * exponent) / (static_cast<double>(nu) * nv));
    }
  };
  Image result(like.width, like.height);
  fft.backward({&half}, multiply, 1, [&](int row, double* pixels) { std::copy_n(pixels, like.width, result.row(row)); });
  return result;
}

}  // namespace

bool of_one_resolution(const std::vector<Beam>& beams) {
  constexpr double alike = 2e-3;  // of squares
  if (beams.empty()) return true;
  const Matrix root = Matrix(covariance(beams.front()).llt().matrixL()).inverse();
  double least = 1, most = 1;  // of squares of widths over those of the first
  for (const Beam& one : beams) {
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(root * covariance(one) * root.transpose(), Eigen::EigenvaluesOnly);
    least = std::min(least, axes.eigenvalues().minCoeff());
    most = std::max(most, axes.eigenvalues().maxCoeff());
  }
  return most < (1 + alike) * least;
}

Image with_beam(const Image& image, const BeamChange& change, const SkyGrid& grid, int threads) {
  constexpr double known_part = 0.99;
  const Matrix gaussian = between(change, grid);
  const double scale = change.to.major_rad * change.to.minor_rad / (change.from.major_rad * change.from.minor_rad);
  const PaddedFft<double> fft(image.width, image.height, {1}, threads);
  const auto read_finite = [&](int row, double* to) {
    std::transform(image.row(row), image.row(row) + image.width, to,
                   [](double value) { return std::isfinite(value) ? value : 0; });
  };
  Image result = blurred(fft, read_finite, gaussian, image);
  const auto read_known = [&](int row, double* to) {
    std::transform(image.row(row), image.row(row) + image.width, to, [](double value) { return std::isfinite(value) ? 1 : 0; });
  };
  const Image known = blurred(fft, read_known, gaussian, image);
  for (std::size_t i = 0; i < result.pixel.size(); ++i)
    result.pixel[i] = known.pixel[i] < known_part ? std::numeric_limits<double>::quiet_NaN() : scale * result.pixel[i];
  return result;
}

}  // namespace misfit::imager
