#pragma once

#include <array>

namespace misfit::imager {

/// Lagrange's weights of values at −1, 0, 1 and 2, for the cubic through them at t.
inline std::array<double, 4> cubic_weights(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
}

}  // namespace misfit::imager
