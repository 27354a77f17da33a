#pragma once

#include <string>

#include "kernels/kernel.h"

namespace misfit::kernels {

inline constexpr int least_misfit_max_width = 20;
inline constexpr double least_misfit_min_x0 = 0.01;
inline constexpr double least_misfit_max_x0 = 0.49;

/// A least-misfit gridding function as solved, before it is stored as a polynomial: C and h together minimise E, the mean over
/// |x| ≤ x0 of the map error ℓ(x) (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146). Normalised to h(0) = 1.
struct LeastMisfit {
  int width = 0;
  double x0 = 0;
  Origin origin;      ///< E, max ℓ, condition, iterations, precision
  double h_step = 0;  ///< relative size of the last step in h: what h may still be off by
  TapFunction taps;   ///< solved for every t anew; in the arithmetic of the solution, then rounded to doubles
};

/// Solves for `width` at `x0`. The arithmetic is the narrowest whose rounding leaves E right to 1e-6 and h to 1e-8: double, or
/// quadruple, or 256 bits. Width must lie in [1, 20] and x0 in [0.01, 0.49] (std::invalid_argument). Throws std::runtime_error
/// when the iteration does not converge.
LeastMisfit solve_least_misfit(int width, double x0);

/// The solution stored as a polynomial under the name of its family.
inline Kernel store(const std::string& name, const LeastMisfit& solution) {
  return make_kernel(name, solution.x0, solution.taps, solution.origin);
}

}  // namespace misfit::kernels
