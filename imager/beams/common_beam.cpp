#include "imager/beams/common_beam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace misfit::imager {
namespace {

using Matrix = Eigen::Matrix2d;  // xᵀ M⁻¹ x = 1 on the ellipse; x = (east, north)
using Vector = Eigen::Vector2d;

Matrix matrix_of(const Beam& beam) {
  if (!(beam.minor_rad > 0 && beam.major_rad >= beam.minor_rad))
    throw std::invalid_argument("a beam of " + std::to_string(beam.major_rad) + " × " + std::to_string(beam.minor_rad) +
                                " rad; expected axes above 0, the longer first");
  const Vector major(std::sin(beam.position_angle_rad), std::cos(beam.position_angle_rad)), minor(-major.y(), major.x());
  return beam.major_rad * beam.major_rad * major * major.transpose() +
         beam.minor_rad * beam.minor_rad * minor * minor.transpose();
}

Beam beam_of(const Matrix& ellipse) {
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(ellipse);
  const Vector major = axes.eigenvectors().col(1);
  Beam beam;
  beam.major_rad = std::sqrt(axes.eigenvalues()(1));
  beam.minor_rad = std::sqrt(axes.eigenvalues()(0));
  beam.position_angle_rad = std::atan(major.x() / major.y());
  if (major.y() == 0) beam.position_angle_rad = M_PI / 2;
  return beam;
}

/// The point of any of the ellipses that lies farthest outside another ellipse, and its (x/r)².
struct Farthest {
  Vector point;
  double square = 0;
};

Farthest farthest(const std::vector<Matrix>& ellipses, const Matrix& from) {
  const Matrix root = from.llt().matrixL(), inverse = root.inverse();
  Farthest most;
  for (const Matrix& ellipse : ellipses) {
    const Matrix seen = inverse * ellipse * inverse.transpose();  // where `from` is the unit circle
    const double half = 0.5 * seen.trace(), apart = std::hypot(0.5 * (seen(0, 0) - seen(1, 1)), seen(0, 1));
    if (half + apart <= most.square) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(seen);
    most.square = axes.eigenvalues()(1);
    most.point = root * axes.eigenvectors().col(1) * std::sqrt(most.square);
  }
  return most;
}

}  // namespace

Beam common_beam(const std::vector<Beam>& beams) {
  if (beams.empty()) throw std::invalid_argument("no beams to enclose; expected one at least");
  constexpr double tolerance = 5e-4;  // of the axes squared: what the area exceeds the least by
  constexpr int most_steps = 20000;
  std::vector<Matrix> ellipses;
  Matrix sum = Matrix::Zero();
  for (const Beam& beam : beams) sum += ellipses.emplace_back(matrix_of(beam)) / static_cast<double>(beams.size());
  Matrix moments = sum / 2;  // Σ weight · x xᵀ of points x, of which the Löwner ellipse is twice
  Farthest most = farthest(ellipses, moments);
  for (int step = 0; step < most_steps && most.square > 2 * (1 + tolerance); ++step) {
    const double part = (most.square / 2 - 1) / (most.square - 1);
    moments = (1 - part) * moments + part * most.point * most.point.transpose();
    most = farthest(ellipses, moments);
  }
  return beam_of(most.square * moments);
}

}  // namespace misfit::imager
