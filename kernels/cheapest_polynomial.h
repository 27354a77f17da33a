#pragma once

#include "kernels/kernel.h"

namespace misfit::kernels {

/// E of the stored polynomial's Legendre truncation at degree 0, 1, … up to its own, each with the correction that is optimal
/// for it. From one series: the error exp(2πitx) − h Σ_r C_r(t) exp(2πi s_r x) is expanded in Legendre polynomials of t, whose
/// squares add, and truncating C removes its part from all terms beyond the degree.
Eigen::VectorXd mean_error_by_degree(const Kernel& kernel);

/// The truncation of lowest degree whose E is at most (1 + allowed_excess) times that of the stored polynomial.
PiecewisePolynomial cheapest_polynomial(const Kernel& kernel, double allowed_excess);

}  // namespace misfit::kernels
