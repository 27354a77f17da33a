#pragma once

#include <functional>
#include <vector>

#include "kernels/kernel.h"

namespace misfit::kernels {

inline constexpr int least_misfit_max_width = 11;
inline constexpr double least_misfit_min_x0 = 0.05;
inline constexpr double least_misfit_max_x0 = 0.49;

/// A least-misfit gridding function as solved, before it is stored as a polynomial: C and h together minimise E, the mean over
/// |x| ≤ x0 of the map error ℓ(x) (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146). Normalised to h(0) = 1.
struct LeastMisfit {
  int width = 0;
  double x0 = 0;
  double mean_error = 0;  ///< E
  int iterations = 0;
  TapFunction taps;
};

/// Solves for widths 1 … `width` at `x0`, since each solution starts the next, and returns them all ([0] is W = 1).
/// Width must lie in [1, 11] and x0 in [0.05, 0.49] (std::invalid_argument). Throws std::runtime_error when a solution does not
/// converge. E is converged to 1e-6 relative where it exceeds 1e-29; below that it is rounding of doubles.
std::vector<LeastMisfit> solve_least_misfit(int width, double x0);

/// The least-misfit functions of widths 1 … `width`, stored as polynomials.
std::vector<Kernel> least_misfit_up_to(int width, double x0);

}  // namespace misfit::kernels
