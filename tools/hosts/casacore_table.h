#pragma once

#include <Eigen/Core>

#include "kernels/piecewise_polynomial.h"

namespace misfit::hosts {

/// casacore's ConvolveGridder, and CASA's GridFT with it, visit the seven cells around the one nearest to a visibility.
inline constexpr int casacore_support = 3;
inline constexpr int casacore_cells = 2 * casacore_support + 1;

/// casacore's half table: entry i is C at |u| = i / per_cell, i = 0 … (support + 1)·per_cell − 1 with support 3; zeros beyond
/// W/2. At |u| = W/2 it is half the limit from inside, the mean of both sides as at any other jump, because both ends of C are
/// read for a visibility halfway; but the limit itself for W = 7, of which one end lies outside the seven cells then. Widths to
/// 7 and 1 to 2^20 entries a cell, std::invalid_argument beyond.
Eigen::VectorXd casacore_table(const kernels::PiecewisePolynomial& function, int per_cell);

/// The seven taps that ConvolveGridder makes of such a table: nearest entry (Fortran nint: halves away from zero), divided by
/// their sum.
kernels::TapFunction casacore_taps(const Eigen::VectorXd& table, int per_cell);

}  // namespace misfit::hosts
