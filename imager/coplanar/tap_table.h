#pragma once

#include <optional>
#include <vector>

#include "kernels/lookup_table.h"

namespace misfit::imager {

/// W taps with the zeros that fill their vectors: a multiple of 4, and of 8 where 12 floats would leave vectors half as wide.
template <typename Real>
constexpr int padded_taps(int width) {
  const int padded = (width + 3) / 4 * 4;
  return sizeof(Real) == 4 && padded == 12 ? 16 : padded;
}

/// A kernel as the inner loops want it, its taps padded with zeros: polynomials, or a lookup table of them.
template <typename Real>
struct TapTable {
  int width = 0;
  int padded = 0;
  int degree = 0;
  std::vector<Real> coefficient;                ///< [power][tap]
  std::optional<kernels::TableOptions> lookup;  ///< taps are looked up where this is given
  int last = 0;                                 ///< the last entry from which a stencil starts
  std::vector<Real> entry;                      ///< [t ≥ 0, t < 0][entry][tap]

  explicit TapTable(const kernels::PiecewisePolynomial& kernel, const std::optional<kernels::TableOptions>& lookup = {});
};

/// The widest kernel that the loops take, in cells.
inline constexpr int most_taps = 20;

}  // namespace misfit::imager
