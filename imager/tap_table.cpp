#include "imager/tap_table.h"

#include <stdexcept>
#include <string>

namespace misfit::imager {

template <typename Real>
TapTable<Real>::TapTable(const kernels::PiecewisePolynomial& kernel)
    : width(kernel.width()), padded(padded_taps<Real>(kernel.width())), degree(kernel.degree()) {
  if (padded > most_taps) throw std::invalid_argument("kernel width " + std::to_string(width) + " not in [1, 20]");
  coefficient.resize((static_cast<std::size_t>(degree) + 1) * static_cast<std::size_t>(padded));
  for (int power = 0; power <= degree; ++power)
    for (int tap = 0; tap < width; ++tap)
      coefficient[static_cast<std::size_t>(power) * static_cast<std::size_t>(padded) + static_cast<std::size_t>(tap)] =
          static_cast<Real>(kernel.coefficient(power, tap));
}

template struct TapTable<float>;
template struct TapTable<double>;

}  // namespace misfit::imager
