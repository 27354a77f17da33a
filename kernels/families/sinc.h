#pragma once

#include <cmath>

namespace misfit::kernels {

/// sin(πu) / (πu)
inline double sinc(double u) {
  const double phase = std::acos(-1.0) * u;
  return phase == 0 ? 1 : std::sin(phase) / phase;
}

}  // namespace misfit::kernels
