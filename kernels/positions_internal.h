#pragma once

#include <Eigen/Core>

#include "kernels/quadrature.h"

namespace misfit::kernels {

/// Positions t of a visibility in its cell at which taps are looked at. C(−u) = C(u) makes [0, ½] stand for the whole cell.
struct Positions {
  Quadrature mean;          ///< weights of sum 1
  Eigen::VectorXd extreme;  ///< where the largest error is looked for
};

/// For taps that are smooth over the cell: enough points for the square of a tap, a polynomial of degree 40 at most, times a
/// slowly turning phase.
Positions smooth_positions();

/// For taps that are smooth only between multiples of 1/(2·steps), as are the taps of a lookup table with `steps` entries a
/// cell: Gauss rules between these points. If there are more than 256 pairs of pieces, 28 are taken. That is enough, because
/// the error of a table is a function G(t, p) of the place t of the pair in the cell and of the place p within the pair, smooth
/// in t: the sum over all pairs is the integral over t but for G''/(24 steps²), by the midpoint rule, and the 28 pairs, those
/// around Gauss nodes with weights made for where they really lie, integrate polynomials of degree 27 in t.
Positions stepped_positions(int steps);

}  // namespace misfit::kernels
