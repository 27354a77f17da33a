#include "kernels/polynomial_taps.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace misfit::kernels {
namespace {

constexpr int most_cells = 20;

/// out_r = Σ_k coefficient[k][r] x^k by Horner's rule, in all cells together.
template <typename Real, int Cells>
void horner_in(const std::vector<Real>& coefficient, Real x, Real* out) {
  std::array<Real, Cells> value{};
  const Real* const end = coefficient.data() + coefficient.size();
  for (const Real* c = coefficient.data(); c != end; c += Cells)
    for (int r = 0; r < Cells; ++r) value[static_cast<std::size_t>(r)] = value[static_cast<std::size_t>(r)] * x + c[r];
  std::copy(value.begin(), value.end(), out);
}

template <typename Real, std::size_t... Index>
auto horners(std::index_sequence<Index...>) {
  return std::array{&horner_in<Real, static_cast<int>(Index) + 1>...};
}

/// The number of cells is made known to the compiler, which then keeps the values in registers.
template <typename Real>
void horner(const std::vector<Real>& coefficient, int cells, Real x, Real* out) {
  static const auto of_cells = horners<Real>(std::make_index_sequence<most_cells>());
  of_cells[static_cast<std::size_t>(cells - 1)](coefficient, x, out);
}

int checked_width(int width) {
  if (width < 1 || width > most_cells)
    throw std::invalid_argument("taps of " + std::to_string(width) + " cells; expected 1 to " + std::to_string(most_cells));
  return width;
}

/// Rows `first`, `first` + `step`, …, from the highest power down, of the first `cells` columns.
template <typename Real>
std::vector<Real> powers(const Eigen::MatrixXd& coefficient, int first, int step, int cells) {
  std::vector<Real> found;
  const auto degree = static_cast<int>(coefficient.rows()) - 1;
  if (degree < first) return found;
  for (int d = degree - (degree - first) % step; d >= first; d -= step)
    for (int r = 0; r < cells; ++r) found.push_back(static_cast<Real>(coefficient(d, r)));
  return found;
}

}  // namespace

template <typename Real>
PlainPolynomial<Real>::PlainPolynomial(const PiecewisePolynomial& kernel)
    : width_(checked_width(kernel.width())), coefficient_(powers<Real>(kernel.coefficient, 0, 1, width_)) {}

template <typename Real>
void PlainPolynomial<Real>::taps(Real t, Real* out) const {
  horner(coefficient_, width_, t, out);
}

template <typename Real>
EvenOddPolynomial<Real>::EvenOddPolynomial(const PiecewisePolynomial& kernel)
    : width_(checked_width(kernel.width())),
      cells_((width_ + 1) / 2),
      even_(powers<Real>(kernel.coefficient, 0, 2, cells_)),
      odd_(powers<Real>(kernel.coefficient, 1, 2, width_ / 2)) {}

template <typename Real>
void EvenOddPolynomial<Real>::taps(Real t, Real* out) const {
  horner(even_, cells_, t * t, out);
  const int pairs = width_ / 2;
  if (pairs == 0) return;
  Real* odd = out + cells_;  // the mirrored taps' places, until they are known
  horner(odd_, pairs, t * t, odd);
  for (int r = 0; r < pairs; ++r) odd[r] *= t;
  std::reverse(odd, odd + pairs);
  for (int r = 0; r < pairs; ++r) {
    const Real even_part = out[r];
    Real& mirrored = out[width_ - 1 - r];
    out[r] = even_part + mirrored;
    mirrored = even_part - mirrored;
  }
}

template class PlainPolynomial<float>;
template class PlainPolynomial<double>;
template class EvenOddPolynomial<float>;
template class EvenOddPolynomial<double>;

}  // namespace misfit::kernels
