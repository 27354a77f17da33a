#pragma once

#include <cstddef>
#include <vector>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// Taps of a polynomial for loops that want no allocation; widths to 20, std::invalid_argument beyond. `Real`, float or double,
/// is the type of coefficients and arithmetic.

/// Horner's rule in every cell.
template <typename Real>
class PlainPolynomial {
 public:
  explicit PlainPolynomial(const PiecewisePolynomial& kernel);

  /// Writes the W taps at t to `out`.
  void taps(Real t, Real* out) const;

  int width() const { return width_; }
  std::size_t bytes() const { return coefficient_.size() * sizeof(Real); }

 private:
  int width_;
  std::vector<Real> coefficient_;  ///< [power of t, descending][tap]
};

/// The polynomials of a symmetric function, split into even and odd powers of t. C(−u) = C(u) makes the taps r and W−1−r of a
/// visibility the sum and the difference of the same two halves, E_r(t²) ± t O_r(t²): two taps for the price of one, from
/// ceil(W/2) cells. The difference costs accuracy where one tap is small and its mirror image large: it takes over the larger
/// one's rounding.
template <typename Real>
class EvenOddPolynomial {
 public:
  /// Takes the cells r < W/2 of `kernel`, whose others must mirror them, as fit_polynomial makes them.
  explicit EvenOddPolynomial(const PiecewisePolynomial& kernel);

  /// Writes the W taps at t to `out`.
  void taps(Real t, Real* out) const;

  int width() const { return width_; }
  std::size_t bytes() const { return (even_.size() + odd_.size()) * sizeof(Real); }

 private:
  int width_;
  int cells_;               ///< ceil(W/2)
  std::vector<Real> even_;  ///< [power of t², descending][cell]
  std::vector<Real> odd_;   ///< [power of t², descending][cell], without the middle cell, which is even
};

extern template class PlainPolynomial<float>;
extern template class PlainPolynomial<double>;
extern template class EvenOddPolynomial<float>;
extern template class EvenOddPolynomial<double>;

}  // namespace misfit::kernels
