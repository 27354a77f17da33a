#pragma once

#include <Eigen/Core>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// C at |u| = i / per_cell for i = 0 … ⌊W·per_cell/2⌋, as hosts that look values up need it. Where C jumps at such a point,
/// between two cells, the value is the mean of both sides; at |u| = W/2 it is the limit from inside.
Eigen::VectorXd sampled_function(const PiecewisePolynomial& polynomial, int per_cell);

/// C at any u, symmetric to the bit: the mean of both sides where C jumps, the limit from inside at |u| = W/2, 0 beyond, NaN
/// for NaN.
Eigen::VectorXd function_values(const PiecewisePolynomial& polynomial, const Eigen::VectorXd& u);

/// sampled_function() for hosts that read both ends of the function for a visibility halfway between them: at |u| = W/2 the
/// mean of both sides too, half the limit from inside.
Eigen::VectorXd sampled_to_both_ends(const PiecewisePolynomial& polynomial, int per_cell);

/// The taps of a host that looks up, for each of the 2·support + 1 cells around the nearest one, the nearest of the table's
/// entries |u| = i / per_cell, halves rounded away from zero; zero beyond the table's end.
TapFunction nearest_entries(const Eigen::VectorXd& table, int per_cell, int support);

}  // namespace misfit::kernels
