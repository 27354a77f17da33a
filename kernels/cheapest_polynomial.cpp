#include "kernels/cheapest_polynomial.h"

#include <cmath>
#include <complex>

#include "kernels/quadrature.h"

namespace misfit::kernels {
namespace {

/// Wider than double where the machine has it: the transform must not add rounding of its own to that of the coefficients.
using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using ComplexMatrix = Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic>;

/// The terms of exp(2πitx) beyond are below 1e-40 for |x| ≤ ½.
constexpr int terms = highest_degree + 14;

/// √(2k+1) P_k(2t), orthonormal over the cell, times the weights of the rule: [k][t].
Matrix legendre_transform(const QuadratureOf<Real>& t) {
  Matrix transform(terms, t.node.size());
  for (int k = 0; k < terms; ++k)
    for (Eigen::Index i = 0; i < t.node.size(); ++i)
      transform(k, i) = std::sqrt(Real(2 * k + 1)) * t.weight[i] * LegendrePair<Real>(k, 2 * t.node[i]).last;
  return transform;
}

/// exp(2πi a_j b_k).
ComplexMatrix turns(const Vector& a, const Vector& b) {
  const Matrix phase = 2 * std::acos(Real(-1)) * a * b.transpose();
  ComplexMatrix turn(a.size(), b.size());
  turn.real() = phase.array().cos();
  turn.imag() = phase.array().sin();
  return turn;
}

/// Legendre terms over t, [k][x], of the exact phasor and of the kernel's sum.
struct Expanded {
  ComplexMatrix wanted;  ///< exp(2πitx)
  ComplexMatrix sum;     ///< Σ_r C_r(t) exp(2πi s_r x)
};

Expanded expand(const PiecewisePolynomial& kernel, const Vector& x) {
  const QuadratureOf<Real> t = gauss_legendre_in<Real>(terms + 10, Real(-0.5), Real(0.5));
  const int width = kernel.width();
  Matrix taps = Matrix::Zero(t.node.size(), width);
  for (int d = kernel.degree(); d >= 0; --d) {
    taps = t.node.asDiagonal() * taps;
    taps.rowwise() += kernel.coefficient.row(d).cast<Real>();
  }
  Vector offset(width);
  for (int r = 0; r < width; ++r) offset[r] = r - Real(width - 1) / 2;
  const Matrix transform = legendre_transform(t);
  return {transform * turns(t.node, x), (transform * taps) * turns(offset, x)};
}

}  // namespace

Eigen::VectorXd mean_error_by_degree(const Kernel& kernel) {
  const QuadratureOf<Real> x = gauss_legendre_in<Real>(48, 0, kernel.x0);
  const Expanded e = expand(kernel.polynomial, x.node);
  const int degree = kernel.polynomial.degree();
  Eigen::VectorXd error(degree + 1);
  for (int d = 0; d <= degree; ++d) {
    const auto wanted = e.wanted.topRows(d + 1);
    const auto sum = e.sum.topRows(d + 1);
    const Vector c = wanted.conjugate().cwiseProduct(sum).real().colwise().sum();
    const Vector h = c.cwiseQuotient(Vector(sum.cwiseAbs2().colwise().sum()));
    const Vector kept = (wanted - sum * h.asDiagonal()).cwiseAbs2().colwise().sum();
    const Vector lost = e.wanted.bottomRows(terms - d - 1).cwiseAbs2().colwise().sum();
    error[d] = static_cast<double>((kept + lost).dot(x.weight) / Real(kernel.x0));
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
