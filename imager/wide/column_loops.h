#pragma once

#include <complex>

#include "imager/coplanar/correction.h"
#include "imager/wide/facet.h"

namespace misfit::imager {

/// q of a facet's column, from its first row to its last; NaN beyond the horizon. See Facet.
void curvature_of_column(const Facet& facet, int column, double* q);

/// h[i] = h(scale · q[i]).
void correction_of_column(const SmoothCorrection& correction, double scale, const double* q, int count, double* h);

/// A phasor for each pixel of a column, or a sum that phasors turn.
struct ColumnPhasors {
  double* real = nullptr;
  double* imaginary = nullptr;

  ColumnPhasors from(std::size_t i) const { return {real + i, imaginary + i}; }
};

/// One step of Horner's rule: sum[i] = sum[i] · half_step[i]² + value[i].
void turn_and_add(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<float>* value, int count);
void turn_and_add(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<double>* value, int count);

/// The transpose of turn_and_add(): value[i] = sum[i], then sum[i] = sum[i] · conj(half_step[i]²).
void store_and_turn(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<float>* value, int count);
void store_and_turn(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<double>* value, int count);

}  // namespace misfit::imager
