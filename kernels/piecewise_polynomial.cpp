#include "kernels/piecewise_polynomial.h"

#include "kernels/quadrature.h"

namespace misfit::kernels {
namespace {

/// Coefficients of the Legendre polynomials P_k(2t) in powers of t: [power][k].
Eigen::MatrixXd legendre_in_powers(int degree) {
  Eigen::MatrixXd power = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  power(0, 0) = 1;
  if (degree > 0) power(1, 1) = 2;
  for (int k = 2; k <= degree; ++k) {
    power.col(k).tail(degree) = (2 * k - 1) * 2.0 / k * power.col(k - 1).head(degree);
    power.col(k) -= (k - 1.0) / k * power.col(k - 2);
  }
  return power;
}

}  // namespace

Eigen::VectorXd PiecewisePolynomial::operator()(double t) const {
  Eigen::VectorXd value = coefficient.row(degree());
  for (int d = degree() - 1; d >= 0; --d) value = value * t + coefficient.row(d).transpose();
  return value;
}

PiecewisePolynomial fit_polynomial(const TapFunction& taps, int degree) {
  const Quadrature rule = gauss_legendre(degree + 14, -0.5, 0.5);
  const Eigen::Index width = taps(0).size();
  const Eigen::MatrixXd powers = legendre_in_powers(degree);
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(degree + 1, width);
  for (Eigen::Index i = 0; i < rule.node.size(); ++i) {
    Eigen::RowVectorXd monomial(degree + 1);
    monomial[0] = 1;
    for (int d = 1; d <= degree; ++d) monomial[d] = monomial[d - 1] * rule.node[i];
    const Eigen::RowVectorXd legendre = monomial * powers;
    series += rule.weight[i] * legendre.transpose() * taps(rule.node[i]).transpose();
  }
  for (int k = 0; k <= degree; ++k) series.row(k) *= 2 * k + 1;

  PiecewisePolynomial result{powers * series};
  for (int d = 0; d <= degree; ++d) {
    const double parity = d % 2 == 0 ? 1 : -1;
    const Eigen::RowVectorXd mirrored = parity * result.coefficient.row(d).reverse();
    result.coefficient.row(d) = (result.coefficient.row(d) + mirrored).eval() / 2;
  }
  return result;
}

}  // namespace misfit::kernels
