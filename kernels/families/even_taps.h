#pragma once

#include <cmath>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// The taps of a function that is given by its values at |u| ≤ W/2, u in cells: `value(|u|)`, or `value(η)` with η = 2|u|/W.
template <typename Value>
TapFunction taps_over_cells(int width, Value value) {
  return [width, value](double t) {
    Eigen::VectorXd taps(width);
    for (int r = 0; r < width; ++r) taps[r] = value(std::abs(r - (width - 1) / 2.0 - t));
    return taps;
  };
}

template <typename Value>
TapFunction taps_over_support(int width, Value value) {
  return taps_over_cells(width, [half = width / 2.0, value](double u) { return value(u / half); });
}

}  // namespace misfit::kernels
