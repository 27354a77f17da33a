#include "kernels/even_odd_polynomial.h"

#include <array>

namespace misfit::kernels {
namespace {

constexpr int most_cells = 32;  // of widths to 64, beyond all there are

/// Σ coefficient · square^k in every cell, by Horner's rule.
template <typename Real>
std::array<Real, most_cells> horner(const std::vector<Real>& coefficient, int cells, Real square) {
  std::array<Real, most_cells> value{};
  for (std::size_t at = 0; at < coefficient.size(); at += static_cast<std::size_t>(cells))
    for (std::size_t r = 0; r < static_cast<std::size_t>(cells); ++r) value[r] = value[r] * square + coefficient[at + r];
  return value;
}

/// Rows of the parity of `first`, from the highest power down, of the first `cells` columns.
template <typename Real>
std::vector<Real> powers(const Eigen::MatrixXd& coefficient, int first, int cells) {
  std::vector<Real> found;
  const auto degree = static_cast<int>(coefficient.rows()) - 1;
  for (int d = degree - (degree - first) % 2; d >= first; d -= 2)
    for (int r = 0; r < cells; ++r) found.push_back(static_cast<Real>(coefficient(d, r)));
  return found;
}

}  // namespace

template <typename Real>
EvenOddPolynomial<Real>::EvenOddPolynomial(const PiecewisePolynomial& kernel)
    : width_(kernel.width()),
      cells_((width_ + 1) / 2),
      even_(powers<Real>(kernel.coefficient, 0, cells_)),
      odd_(powers<Real>(kernel.coefficient, 1, width_ / 2)) {}

template <typename Real>
void EvenOddPolynomial<Real>::taps(Real t, Real* out) const {
  const Real square = t * t;
  const std::array<Real, most_cells> even = horner(even_, cells_, square);
  if (width_ % 2 == 1) out[width_ / 2] = even[static_cast<std::size_t>(width_ / 2)];
  if (width_ == 1) return;
  const std::array<Real, most_cells> odd = horner(odd_, width_ / 2, square);
  for (int r = 0; r < width_ / 2; ++r) {
    const auto cell = static_cast<std::size_t>(r);
    out[r] = even[cell] + t * odd[cell];
    out[width_ - 1 - r] = even[cell] - t * odd[cell];
  }
}

template class EvenOddPolynomial<float>;
template class EvenOddPolynomial<double>;

}  // namespace misfit::kernels
