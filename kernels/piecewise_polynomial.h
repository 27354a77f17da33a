#pragma once

#include <Eigen/Core>
#include <functional>

namespace misfit::kernels {

/// The W values that a gridding function C takes on the grid around a visibility: tap r is C(s_r − t), where t in [−½, ½] is
/// the position of the visibility from the middle of its cell and s_r = r − (W−1)/2. Writing it this way serves odd and even W
/// alike, and C may jump where cells meet.
using TapFunction = std::function<Eigen::VectorXd(double t)>;

/// A gridding function as one polynomial a cell: C(s_r − t) = Σ_d coefficient(d, r) t^d.
struct PiecewisePolynomial {
  Eigen::MatrixXd coefficient;  ///< [degree + 1][W]

  int width() const { return static_cast<int>(coefficient.cols()); }
  int degree() const { return static_cast<int>(coefficient.rows()) - 1; }
  /// The taps at t, by Horner's rule.
  Eigen::VectorXd operator()(double t) const;
};

/// The highest degree that is ever stored: beyond, a Legendre term of a double is rounding.
inline constexpr int highest_degree = 24;

/// The best polynomial of `degree` in each cell in the sense of least squares over t: the truncated Legendre series. The
/// symmetry C(−u) = C(u) holds exactly in the result. The degree lies in [0, 24] (std::invalid_argument).
PiecewisePolynomial fit_polynomial(const TapFunction& taps, int degree);

/// The best polynomial of the lowest degree that leaves a mean square Σ_r ∫ |fit_r − C_r|² dt of at most `mean_square`; of
/// highest_degree where none does.
PiecewisePolynomial fit_polynomial_within(const TapFunction& taps, double mean_square);

/// The RMS of the polynomials' Legendre terms of degree 21 to 24 = highest_degree over the RMS of the polynomials. A value
/// above rounding says that the series was cut before it converged, and errs by as much or somewhat more: the function bends or
/// jumps inside a cell.
double part_in_last_terms(const PiecewisePolynomial& polynomial);

}  // namespace misfit::kernels
