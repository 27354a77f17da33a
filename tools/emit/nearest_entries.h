#pragma once

#include <Eigen/Core>

#include "kernels/piecewise_polynomial.h"

namespace misfit::tools {

/// C at |u| = i / per_cell, i = 0 … ⌊W·per_cell/2⌋, for hosts that read it at both ends of an even number of cells: there, at
/// |u| = W/2, it is half the limit from inside, and so is what such a host reads twice.
Eigen::VectorXd half_table(const kernels::PiecewisePolynomial& function, int per_cell);

/// The taps of a host that gives the 2·support + 1 cells around the nearest one the nearest of the table's entries, zero beyond
/// its end.
kernels::TapFunction nearest_entries(const Eigen::VectorXd& table, int per_cell, int support);

}  // namespace misfit::tools
