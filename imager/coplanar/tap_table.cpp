#include "imager/coplanar/tap_table.h"

#include <stdexcept>
#include <string>

namespace misfit::imager {

template <typename Real>
TapTable<Real>::TapTable(const kernels::PiecewisePolynomial& kernel, const std::optional<kernels::TableOptions>& table)
    : width(kernel.width()), padded(padded_taps<Real>(kernel.width())), degree(kernel.degree()), lookup(table) {
  if (padded > most_taps) throw std::invalid_argument("kernel width " + std::to_string(width) + " not in [1, 20]");
  coefficient.resize((static_cast<std::size_t>(degree) + 1) * static_cast<std::size_t>(padded));
  for (int power = 0; power <= degree; ++power)
    for (int tap = 0; tap < width; ++tap)
      coefficient[static_cast<std::size_t>(power) * static_cast<std::size_t>(padded) + static_cast<std::size_t>(tap)] =
          static_cast<Real>(kernel.coefficient(power, tap));
  if (!lookup) return;
  const kernels::LookupTable<Real> half(kernel, *lookup);
  last = half.last();
  const std::size_t taps = static_cast<std::size_t>(width), entries = half.entries().size() / taps;
  entry.resize(2 * entries * static_cast<std::size_t>(padded));
  for (std::size_t k = 0; k < entries; ++k) {
    const auto from = half.entries().begin() + static_cast<std::ptrdiff_t>(k * taps);
    const auto to = entry.begin() + static_cast<std::ptrdiff_t>(k) * padded;
    std::copy_n(from, width, to);
    std::reverse_copy(from, from + width, to + static_cast<std::ptrdiff_t>(entries) * padded);
  }
}

template struct TapTable<float>;
template struct TapTable<double>;

}  // namespace misfit::imager
