#include "kernels/piecewise_polynomial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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

/// Legendre coefficients of the taps in t: [degree][tap].
Eigen::MatrixXd legendre_series(const TapFunction& taps, int degree) {
  const Quadrature rule = gauss_legendre(degree + 14, -0.5, 0.5);
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(degree + 1, taps(0).size());
  Eigen::VectorXd legendre(degree + 1);
  for (Eigen::Index i = 0; i < rule.node.size(); ++i) {
    for (int k = 0; k <= degree; ++k) legendre[k] = (2 * k + 1) * LegendrePair<double>(k, 2 * rule.node[i]).last;
    series += rule.weight[i] * legendre * taps(rule.node[i]).transpose();
  }
  return series;
}

/// The series in powers of t, with C(−u) = C(u) made exact.
PiecewisePolynomial in_powers(const Eigen::MatrixXd& series) {
  const auto degree = static_cast<int>(series.rows()) - 1;
  PiecewisePolynomial result{legendre_in_powers(degree) * series};
  for (int d = 0; d <= degree; ++d) {
    const Eigen::RowVectorXd mirrored = (d % 2 == 0 ? 1 : -1) * result.coefficient.row(d).reverse();
    result.coefficient.row(d) = (result.coefficient.row(d) + mirrored).eval() / 2;
  }
  return result;
}

}  // namespace

Eigen::VectorXd PiecewisePolynomial::operator()(double t) const {
  Eigen::VectorXd value = coefficient.row(degree());
  for (int d = degree() - 1; d >= 0; --d) value = value * t + coefficient.row(d).transpose();
  return value;
}

PiecewisePolynomial fit_polynomial(const TapFunction& taps, int degree) {
  if (degree < 0 || degree > highest_degree)
    throw std::invalid_argument("polynomial degree " + std::to_string(degree) + " not in [0, " +
                                std::to_string(highest_degree) + "]");
  return in_powers(legendre_series(taps, degree));
}

PiecewisePolynomial fit_polynomial_within(const TapFunction& taps, double mean_square) {
  const Eigen::MatrixXd series = legendre_series(taps, highest_degree);
  // High terms of taps that were rounded to doubles are noise: their sum would never fall below what doubles hold.
  constexpr double unit = 0x1p-53;
  const double noise = unit * unit * static_cast<double>(series.cols());
  double left = 0;
  int degree = highest_degree;
  for (; degree > 0; --degree) {
    const double term = series.row(degree).squaredNorm() / (2 * degree + 1);
    if (term > noise) left += term;
    if (left > mean_square) break;
  }
  return in_powers(series.topRows(degree + 1));
}

double part_in_last_terms(const PiecewisePolynomial& polynomial) {
  constexpr int last = 4;
  if (polynomial.degree() <= highest_degree - last) return 0;
  Eigen::VectorXd square = legendre_series(polynomial, highest_degree).rowwise().squaredNorm();
  for (int degree = 0; degree <= highest_degree; ++degree) square[degree] /= 2 * degree + 1;
  return std::sqrt(square.tail(last).sum() / square.sum());
}

}  // namespace misfit::kernels
