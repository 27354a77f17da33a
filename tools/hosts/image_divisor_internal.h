#pragma once

#include <Eigen/Core>

#include "kernels/piecewise_polynomial.h"

namespace misfit::hosts {

/// 1/h, by which casacore divides an image, at the `length` pixels x = (i − length/2)/length of an axis, with h the optimal
/// correction of these taps (for `steps_per_cell` see kernels::JudgeOptions). Its size is kept within [1e-15, 1e15]: one over
/// the product of two is then finite in single precision, also far beyond x0 where taps may leave nothing of the image.
Eigen::VectorXd image_divisor(const kernels::TapFunction& taps, int length, int steps_per_cell = 0);

}  // namespace misfit::hosts
