#pragma once

#include "imager/coplanar/tap_table.h"

namespace misfit::imager {

/// The taps of many samples along one axis: [sample][padded], as TapTable has them.
template <typename Real, int Capacity>
struct BatchTaps {
  alignas(64) Real value[Capacity * most_taps];
};

/// out[i][r] = Σ_d coefficient_d,r t_i^d for the padded taps of `count` samples, or the taps of LookupTable. `out` is aligned
/// to 64 bytes.
void evaluate_taps(const TapTable<float>& table, const float* t, int count, float* out);
void evaluate_taps(const TapTable<double>& table, const double* t, int count, double* out);

}  // namespace misfit::imager
