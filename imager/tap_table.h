#pragma once

#include <vector>

#include "kernels/piecewise_polynomial.h"

namespace misfit::imager {

/// W taps with the zeros that fill their vectors: a multiple of 4, and of 8 where 12 floats would leave vectors half as wide.
template <typename Real>
constexpr int padded_taps(int width) {
  const int padded = (width + 3) / 4 * 4;
  return sizeof(Real) == 4 && padded == 12 ? 16 : padded;
}

/// A kernel's polynomials as the inner loops want them: [power][tap], padded with zeros.
template <typename Real>
struct TapTable {
  int width = 0;
  int padded = 0;
  int degree = 0;
  std::vector<Real> coefficient;

  explicit TapTable(const kernels::PiecewisePolynomial& kernel);
};

/// The widest kernel that the loops take, in cells.
inline constexpr int most_taps = 20;

}  // namespace misfit::imager
