#pragma once

#include "imager/plan/axis_kernel.h"
#include "imager/plan/cost_model.h"
#include "imager/plan/faceting.h"

namespace misfit::imager {

/// Relative RMS of the rounding of exp(2πi turns) in double precision, where `turns` is the largest there is.
double phase_rounding(double turns);

/// One way to grid, with its cost and its errors.
struct GriddingCandidate {
  GriddingWork work;
  double padding_u = 1;
  double padding_v = 1;
  double padding_w = 1;
  AxisKernel u;
  AxisKernel v;
  AxisKernel w;               ///< all zero errors without a w axis
  Faceting faceting;          ///< the whole image as one facet without a w axis
  double turns = 0;           ///< the largest phases beside those of the FFT: of w, and of an image off the phase centre
  double cost_s = 0;          ///< by the fixed constants; see CostModel
  double rounding = 0;        ///< RMS of rounding, relative
  double expected_error = 0;  ///< RMS error of image and prediction relative to data with random phases, √(E_u + E_v + E_w)
  double worst_error = 0;  ///< expected_error for the worst position of samples in their cells, or the worst pixel of a model
};

/// Fills in the errors from the axes and the precision.
void judge(GriddingCandidate& candidate);

/// The candidate with the polynomials of lowest degree that cost less than half a percent of the squared error, rounding
/// counted in.
GriddingCandidate with_shortest_polynomials(const GriddingCandidate& exact);

}  // namespace misfit::imager
