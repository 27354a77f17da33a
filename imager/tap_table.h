#pragma once

#include <vector>

#include "kernels/piecewise_polynomial.h"

namespace misfit::imager {

/// A kernel's polynomials as the inner loops want them: [power][tap], taps padded with zeros to a multiple of 4.
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
