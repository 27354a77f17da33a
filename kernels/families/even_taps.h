#pragma once

#include <cmath>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// The taps of C(u) = value(|u|), |u| ≤ W/2 in cells.
template <typename Value>
TapFunction taps_over_cells(int width, Value value) {
  return [width, value](double t) {
    Eigen::VectorXd taps(width);
    for (int r = 0; r < width; ++r) taps[r] = value(std::abs(r - (width - 1) / 2.0 - t));
    return taps;
  };
}

/// The taps of C(u) = value(η), η = 2|u|/W in [0, 1].
template <typename Value>
TapFunction taps_over_support(int width, Value value) {
  return taps_over_cells(width, [half = width / 2.0, value](double u) { return value(u / half); });
}

}  // namespace misfit::kernels
