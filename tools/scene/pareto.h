#pragma once

#include <vector>

namespace misfit::tools {

/// What something costs, and how far it is from right.
struct CostAndError {
  double cost = 0;
  double error = 0;
};

/// Whether nothing else is at least as cheap and as exact, and one of both more. Of equals the first alone. What is not finite
/// in either is not on the front. Costs that differ by a part of `noise` count as equal: of those no dearer than 1 + noise
/// times the cheapest that adds to the front, the most exact alone is on it.
std::vector<bool> pareto_front(const std::vector<CostAndError>& of, double noise = 0);

}  // namespace misfit::tools
