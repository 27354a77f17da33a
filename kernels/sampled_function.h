#pragma once

#include <Eigen/Core>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// C at |u| = i / per_cell for i = 0 … ⌊W·per_cell/2⌋, as hosts that look values up need it. Where such a point is one at which
/// C jumps, between two cells, the value is the mean of both sides; at |u| = W/2 it is the limit from inside.
Eigen::VectorXd sampled_function(const PiecewisePolynomial& polynomial, int per_cell);

}  // namespace misfit::kernels
