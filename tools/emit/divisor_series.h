#pragma once

#include <Eigen/Core>

#include "kernels/map_error.h"

namespace misfit::tools {

/// The divisor 1/h(x) of an image along an axis, as a Chebyshev series: Σ_k coefficient[k] T_k(2(x/x0)² − 1) for
/// |x| ≤ x0, and its value at x0 beyond, where the image is thrown away.
struct DivisorSeries {
  double x0 = 0.25;
  Eigen::VectorXd coefficient;

  /// Clenshaw's recurrence (Clenshaw 1955, MTAC 9, 118).
  double operator()(double x) const;
};

/// The series that is true to 1/h to 1e-14 of its largest value, as far as doubles and 48 terms hold it.
DivisorSeries divisor_series(const kernels::Correction& h, double x0);

}  // namespace misfit::tools
