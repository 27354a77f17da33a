#include "kernels/lookup_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace misfit::kernels {
namespace {

constexpr int most_samples = 1 << 24;  // float tells no more positions in a cell apart

int degree_of(Interpolation interpolation) {
  return static_cast<int>(interpolation);
}

template <typename Real, int Degree>
void combine(const Real* entry, Real p, int width, Real* out) {
  const std::array<Real, Degree + 1> weight = newton_weights<Real, Degree>(p);
  for (int r = 0; r < width; ++r) {
    Real sum = weight[0] * entry[r];
    for (int j = 1; j <= Degree; ++j) sum += weight[static_cast<std::size_t>(j)] * entry[j * width + r];
    out[r] = sum;
  }
}

}  // namespace

template <typename Real>
LookupTable<Real>::LookupTable(const PiecewisePolynomial& kernel, const TableOptions& options)
    : width_(kernel.width()), options_(options) {
  const int samples = options.samples_per_cell;
  if (samples < 1 || samples > most_samples)
    throw std::invalid_argument("lookup table of " + std::to_string(samples) + " samples a cell; expected 1 to " +
                                std::to_string(most_samples));
  const int degree = degree_of(options.interpolation);
  last_ = degree == 0 ? samples / 2 : (samples - 1) / 2;
  entry_.resize(static_cast<std::size_t>(last_ + degree + 1) * static_cast<std::size_t>(width_));
  auto at = entry_.begin();
  for (int k = 0; k <= last_ + degree; ++k)
    for (const double value : kernel(static_cast<double>(k) / samples)) *at++ = static_cast<Real>(value);
}

template <typename Real>
void LookupTable<Real>::taps(Real t, Real* out) const {
  const auto [k, p] = place(t);
  const Real* entry = entry_.data() + static_cast<std::ptrdiff_t>(k) * width_;
  switch (options_.interpolation) {
    case Interpolation::nearest:
      combine<Real, 0>(entry, p, width_, out);
      break;
    case Interpolation::linear:
      combine<Real, 1>(entry, p, width_, out);
      break;
    case Interpolation::quadratic:
      combine<Real, 2>(entry, p, width_, out);
      break;
    case Interpolation::cubic:
      combine<Real, 3>(entry, p, width_, out);
      break;
  }
  if (t < 0) std::reverse(out, out + width_);
}

template class LookupTable<float>;
template class LookupTable<double>;

double interpolation_error_factor(Interpolation interpolation) {
  // ∫ binomial(p, d+1)² dp, integrated by hand.
  constexpr std::array<double, 4> square{1.0 / 12, 1.0 / 120, 2.0 / 945, 313.0 / 362880};
  return std::sqrt(square[static_cast<std::size_t>(interpolation)]);
}

double table_misfit(const TableOptions& options, double x0) {
  const int order = degree_of(options.interpolation) + 1;
  const double turn = 2 * std::acos(-1.0) * x0 / options.samples_per_cell;
  const double rms = interpolation_error_factor(options.interpolation) * std::pow(turn, order);
  return rms * rms / (2 * order + 1);
}

}  // namespace misfit::kernels
