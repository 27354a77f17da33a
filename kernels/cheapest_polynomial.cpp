#include "kernels/cheapest_polynomial.h"

#include <cmath>
#include <complex>

#include "kernels/quadrature.h"

namespace misfit::kernels {
namespace {

/// The terms of exp(2πitx) beyond are below 1e-40 for |x| ≤ ½.
constexpr int terms = highest_degree + 14;

/// √(2k+1) P_k(2t), orthonormal over the cell, times the weights of the rule: [k][t].
Eigen::MatrixXd legendre_transform(const Quadrature& t) {
  Eigen::MatrixXd transform(terms, t.node.size());
  for (int k = 0; k < terms; ++k)
    for (Eigen::Index i = 0; i < t.node.size(); ++i)
      transform(k, i) = std::sqrt(2 * k + 1.0) * t.weight[i] * LegendrePair<double>(k, 2 * t.node[i]).last;
  return transform;
}

/// exp(2πi a_j b_k).
Eigen::MatrixXcd turns(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXXd phase = 2 * std::acos(-1.0) * a * b.transpose();
  Eigen::MatrixXcd turn(a.size(), b.size());
  turn.real() = phase.cos();
  turn.imag() = phase.sin();
  return turn;
}

/// Legendre terms over t of what the kernel should add up to and of what it does: [k][x].
struct Expanded {
  Eigen::MatrixXcd wanted;  ///< exp(2πitx)
  Eigen::MatrixXcd sum;     ///< Σ_r C_r(t) exp(2πi s_r x)
};

Expanded expand(const PiecewisePolynomial& kernel, const Eigen::VectorXd& x) {
  const Quadrature t = gauss_legendre(terms + 10, -0.5, 0.5);
  const int width = kernel.width();
  Eigen::MatrixXd taps(t.node.size(), width);
  for (Eigen::Index i = 0; i < t.node.size(); ++i) taps.row(i) = kernel(t.node[i]).transpose();
  const Eigen::VectorXd offset = Eigen::VectorXd::LinSpaced(width, -(width - 1) / 2.0, (width - 1) / 2.0);
  const Eigen::MatrixXd transform = legendre_transform(t);
  return {transform * turns(t.node, x), (transform * taps) * turns(offset, x)};
}

}  // namespace

Eigen::VectorXd mean_error_by_degree(const Kernel& kernel) {
  const Quadrature x = gauss_legendre(48, 0, kernel.x0);
  const Expanded e = expand(kernel.polynomial, x.node);
  const int degree = kernel.polynomial.degree();
  Eigen::VectorXd error(degree + 1);
  for (int d = 0; d <= degree; ++d) {
    const auto wanted = e.wanted.topRows(d + 1);
    const auto sum = e.sum.topRows(d + 1);
    const Eigen::RowVectorXd c = wanted.conjugate().cwiseProduct(sum).real().colwise().sum();
    const Eigen::RowVectorXd h = c.cwiseQuotient(sum.cwiseAbs2().colwise().sum());
    const Eigen::RowVectorXd kept = (wanted - sum * h.asDiagonal()).cwiseAbs2().colwise().sum();
    const Eigen::RowVectorXd lost = e.wanted.bottomRows(terms - d - 1).cwiseAbs2().colwise().sum();
    error[d] = (kept + lost).dot(x.weight) / kernel.x0;
  }
  return error;
}

PiecewisePolynomial cheapest_polynomial(const Kernel& kernel, double allowed_excess) {
  const Eigen::VectorXd error = mean_error_by_degree(kernel);
  const double allowed = (1 + allowed_excess) * error[error.size() - 1];
  int degree = kernel.polynomial.degree();
  while (degree > 0 && error[degree - 1] <= allowed) --degree;
  return degree == kernel.polynomial.degree() ? kernel.polynomial : fit_polynomial(kernel.polynomial, degree);
}

}  // namespace misfit::kernels
