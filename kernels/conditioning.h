#pragma once

#include "kernels/map_error.h"

namespace misfit::kernels {

/// These functions find C for a given h in doubles, in the two textbook ways, to show what rounding does to each. Kernels are
/// solved by solve_least_misfit, which chooses its arithmetic. For every t both minimise the mean over |x| ≤ x0 of
/// |exp(2πitx) − h(x) Σ_r C_r exp(2πi s_r x)|².

/// Solves by Cholesky's factors L D Lᵀ of the W×W normal equations, whose condition is the square of the design matrix's.
TapFunction solve_by_normal_equations(int width, double x0, const Correction& h);

/// Solves by Householder's QR of the design matrix of the cosines and sines.
TapFunction solve_by_orthogonal_factors(int width, double x0, const Correction& h);

/// Taps with their values rounded to single precision, as a table of floats holds them.
TapFunction stored_in_single(const TapFunction& taps);

}  // namespace misfit::kernels
