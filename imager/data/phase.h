#pragma once

#include "imager/data/geometry.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {

/// A position as the phase sees it.
struct PhasePosition {
  double l = 0;
  double m = 0;
  double n_minus_1 = 0;  ///< 0 where w is neglected
};

inline PhasePosition phase_position(DirectionCosines at) {
  return {at.l, at.m, n_minus_1(at)};
}

/// ul + vm + w(n−1) at unit frequency, in turns.
inline double turns_per_hz(const double* uvw_m, const PhasePosition& at) {
  return (uvw_m[0] * at.l + uvw_m[1] * at.m + uvw_m[2] * at.n_minus_1) / speed_of_light_m_s;
}

}  // namespace misfit::imager
