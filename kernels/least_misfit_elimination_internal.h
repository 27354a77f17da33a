#pragma once

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/quadrature.h"

namespace misfit::kernels {

template <typename Real>
using VectorOf = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
template <typename Real>
using MatrixOf = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// The angle θ of every node, and the rule for the mean over |x| ≤ x0; see misfit_nodes.
template <typename Real>
struct NodesOf {
  VectorOf<Real> theta;  ///< over its value at x0
  VectorOf<Real> x;
  VectorOf<Real> weight;

  NodesOf(int nodes, double x0) {
    using std::asin;
    using std::cos;
    using std::sin;
    const Real edge = asin(2 * Real(x0));
    const QuadratureOf<Real> rule = gauss_lobatto_in<Real>(nodes, 1, 0);
    theta = rule.node;
    x.resize(nodes);
    weight.resize(nodes);
    for (int i = 0; i < nodes; ++i) {
      x[i] = sin(edge * theta[i]) / 2;
      weight[i] = -rule.weight[i] * edge * cos(edge * theta[i]) / (2 * Real(x0));
    }
  }
};

/// The misfit E(h) with C eliminated. For every t, C(s_r − t) minimises ∫ |exp(2πitx) − h(x) Σ_r C_r exp(2πi s_r x)|² dx. By
/// symmetry the sums C_r ± C_{W−1−r} solve two problems of half the size: the real part in cosines and the imaginary part in
/// sines. QR of the design matrix, not its normal equations: the latter lose E below eps²·cond. Rows of large h come first, as
/// Householder's method needs for rows of different size.
template <typename Real>
class Half {
 public:
  enum class Parity { even, odd };

  Half(Parity parity, int width, const VectorOf<Real>& x, const VectorOf<Real>& weight, const VectorOf<Real>& h)
      : parity_(parity), x_(x), root_weight_(weight.cwiseSqrt()) {
    for (int r = 0; r < width; ++r) {
      const double s = r - (width - 1) / 2.0;
      if (s > 0 || (s == 0 && parity == Parity::even)) offset_.push_back(s);
    }
    orthonormal_.resize(x_.size(), 0);
    if (offset_.empty()) return;  // W = 1 has no odd part
    MatrixOf<Real> design(x_.size(), static_cast<Eigen::Index>(offset_.size()));
    for (std::size_t k = 0; k < offset_.size(); ++k)
      design.col(static_cast<Eigen::Index>(k)) = root_weight_.cwiseProduct(h).cwiseProduct(wave(offset_[k]));
    factor_.compute(design);
    orthonormal_ = factor_.householderQ() * MatrixOf<Real>::Identity(x_.size(), factor_.rank());
  }

  /// cos or sin(2π s x) at the nodes, weighted.
  VectorOf<Real> weighted_wave(const Real& s) const { return root_weight_.cwiseProduct(wave(s)); }
  /// The part of each column outside the span of the design matrix.
  MatrixOf<Real> outside(const MatrixOf<Real>& columns) const {
    const MatrixOf<Real> along = orthonormal_.transpose() * columns;
    return columns - orthonormal_ * along;
  }
  /// C_r + C_{W−1−r} (even; the middle tap alone) or C_r − C_{W−1−r} (odd) for the offsets s_r ≥ 0.
  VectorOf<Real> solve(const Real& t) const {
    if (offset_.empty()) return VectorOf<Real>();
    return factor_.solve(weighted_wave(t));
  }
  const std::vector<double>& offset() const { return offset_; }
  Parity parity() const { return parity_; }

  struct SingularValues {
    Real largest = 0;
    Real smallest = std::numeric_limits<Real>::max();
  };
  /// The singular values of the design matrix in orthonormal sums (C_r ± C_{W−1−r})/√2, by iteration with its triangular
  /// factor.
  SingularValues singular_values() const {
    SingularValues found;
    const Eigen::Index n = orthonormal_.cols();
    if (n == 0) return found;
    MatrixOf<Real> triangle = factor_.matrixR().topLeftCorner(n, n).template triangularView<Eigen::Upper>();
    for (Eigen::Index k = 0; k < n; ++k)
      if (offset_[static_cast<std::size_t>(factor_.colsPermutation().indices()[k])] != 0)
        triangle.col(k) *= Real(std::sqrt(2.0));
    const auto upper = triangle.template triangularView<Eigen::Upper>();
    const auto lower = triangle.transpose().template triangularView<Eigen::Lower>();
    VectorOf<Real> a = VectorOf<Real>::LinSpaced(n, Real(1), Real(2));
    VectorOf<Real> b = a;
    for (int i = 0; i < 60; ++i) {
      a = (lower * VectorOf<Real>(upper * a)).eval();
      b = upper.solve(VectorOf<Real>(lower.solve(b)));
      using std::sqrt;
      found.largest = sqrt(a.norm());
      found.smallest = 1 / sqrt(b.norm());
      a.normalize();
      b.normalize();
    }
    return found;
  }

 private:
  VectorOf<Real> wave(const Real& s) const {
    using std::acos;
    using std::cos;
    using std::sin;
    static const Real two_pi = 2 * acos(Real(-1));
    VectorOf<Real> value(x_.size());
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const Real phase = two_pi * s * x_[i];
      value[i] = parity_ == Parity::even ? Real(cos(phase)) : Real(sin(phase));
    }
    return value;
  }

  Parity parity_;
  VectorOf<Real> x_;
  VectorOf<Real> root_weight_;
  std::vector<double> offset_;
  Eigen::ColPivHouseholderQR<MatrixOf<Real>> factor_;
  MatrixOf<Real> orthonormal_;
};

}  // namespace misfit::kernels
