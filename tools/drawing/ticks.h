#pragma once

#include <vector>

namespace misfit::tools {

/// 1, 2 or 5 × 10^k, the nearest to `rough`, which is positive.
double round_step(double rough);

/// The multiples of a round step between `low` and `high`, about so many.
std::vector<double> linear_ticks(double low, double high, int about);

/// The values 10^k between `low` and `high`, which are positive: every second or third power where there would be more than
/// eight, and 2 × 10^k and 5 × 10^k too where there would be fewer than three.
std::vector<double> logarithmic_ticks(double low, double high);

}  // namespace misfit::tools
