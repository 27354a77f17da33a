#pragma once

#include "kernels/least_misfit.h"

namespace misfit::kernels {

/// A gridding function whose largest map error over |x| ≤ x0 is the smallest there is for its width. By reweighting (C. L.
/// Lawson 1961, Contributions to the theory of linear least maximum approximation, thesis, UCLA): the function of the smallest
/// weighted mean of ℓ(x) is found again and again, with weights that grow where ℓ is large. Every such mean is a lower bound of
/// what any function's largest ℓ can be; the result is within 5% of the bound (Origin::max_error_bound). Ranges and errors are
/// those of solve_least_misfit.
LeastMisfit solve_minimax(int width, double x0);

}  // namespace misfit::kernels
