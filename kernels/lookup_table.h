#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// How a lookup table is read between its entries: the nearest entry, or the polynomial of degree 1, 2 or 3 through 2, 3 or 4
/// entries. The value is the degree.
enum class Interpolation { nearest, linear, quadratic, cubic };
inline constexpr std::array<const char*, 4> interpolation_names{"nearest", "linear", "quadratic", "cubic"};  ///< by degree

/// A table's shape.
struct TableOptions {
  int samples_per_cell = 64;  ///< Ms: entries lie 1/Ms of a cell apart; in [1, 2^24]
  Interpolation interpolation = Interpolation::cubic;
};

/// The weights of Degree + 1 neighbouring entries in Newton's forward formula, p entries after the first.
template <typename Real, int Degree>
std::array<Real, Degree + 1> newton_weights(Real p) {
  if constexpr (Degree == 0) return {1};
  const Real b2 = p * (p - 1) / 2;
  if constexpr (Degree == 1) return {1 - p, p};
  if constexpr (Degree == 2) return {1 - p + b2, p - 2 * b2, b2};
  const Real b3 = b2 * (p - 2) / 3;
  if constexpr (Degree == 3) return {1 - p + b2 - b3, p - 2 * b2 + 3 * b3, b2 - 3 * b3, b3};
}

/// Where a table is read for one position.
template <typename Real>
struct TablePlace {
  int entry = 0;   ///< the first
  Real after = 0;  ///< how many entries after it the position lies
};

/// A gridding function sampled at t = k/Ms, read by Newton's forward differences: p in [0, 1] cells of the table from entry k,
/// C ≈ Σ_j binomial(p, j) Δ^j C_k (Abramowitz & Stegun 1964, eq. 25.2.28; Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146,
/// tabulate so). Every cell of C has a table of its own, continued beyond the cell's end by the cell's polynomial, so that
/// nothing is interpolated across the jumps of C. C(−u) = C(u): entries for t ≥ 0 serve t < 0 with the taps in reverse, half of
/// what W cells would take. `Real`, float or double, is the type of entries and arithmetic.
template <typename Real>
class LookupTable {
 public:
  /// std::invalid_argument when Ms lies outside its range.
  LookupTable(const PiecewisePolynomial& kernel, const TableOptions& options);

  /// Writes the W taps at t to `out`.
  void taps(Real t, Real* out) const;

  TablePlace<Real> place(Real t) const { return place_in(options_, last_, t); }
  static TablePlace<Real> place_in(const TableOptions& options, int last, Real t) {
    const Real place = std::abs(t) * static_cast<Real>(options.samples_per_cell);
    const bool nearest = options.interpolation == Interpolation::nearest;
    const int entry = std::min(static_cast<int>(nearest ? place + Real(0.5) : place), last);
    return {entry, place - static_cast<Real>(entry)};
  }
  /// [entry][tap] for t ≥ 0.
  const std::vector<Real>& entries() const { return entry_; }
  /// The last entry from which a stencil starts.
  int last() const { return last_; }

  int width() const { return width_; }
  const TableOptions& options() const { return options_; }
  std::size_t bytes() const { return entry_.size() * sizeof(Real); }

 private:
  int width_;
  TableOptions options_;
  int last_;
  std::vector<Real> entry_;
};

extern template class LookupTable<float>;
extern template class LookupTable<double>;

/// The factor κ of a table's error. Interpolation of degree d leaves C^(d+1) binomial(p, d+1) / Ms^(d+1), and κ is the RMS of
/// the binomial over the part of the stencil that is read, p in [0, 1] (nearest: p in [−½, ½]): the roots of 1/12, 1/120, 2/945
/// and 313/362880.
double interpolation_error_factor(Interpolation interpolation);

/// The E that a table of Ms entries a cell adds to its function's E, for any function, as long as the correction is the
/// function's:
///   e² = κ² (2π x0)^(2d+2) / ((2d+3) Ms^(2d+2)),
/// since h Σ_r C_r(t) exp(2πi s_r x) is close to exp(2πitx), whose (d+1)-th derivative has the size (2πx)^(d+1), squared and
/// averaged over |x| ≤ x0.
double table_misfit(const TableOptions& options, double x0);

}  // namespace misfit::kernels
