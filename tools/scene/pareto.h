#pragma once

#include <vector>

namespace misfit::tools {

/// What something costs, and how far it is from right.
struct CostAndError {
  double cost = 0;
  double error = 0;
  double noise = 0;  ///< standard error of the cost, as a part of it
};

/// How many times as long the other takes from which on the two differ by more than noise: 1 + two standard errors of the
/// ratio. What is known to no better than a tenth is treated as though it were, lest all be equal.
double distinct_ratio(const CostAndError& a, const CostAndError& b);

/// Whether nothing else is at least as cheap and as exact, and one of both more. Of equals the first alone. What is not finite
/// in either is not on the front. Of those that cost no more than the cheapest that adds to the front, but for what noise may
/// be, the most exact alone is on it.
std::vector<bool> pareto_front(const std::vector<CostAndError>& of);

}  // namespace misfit::tools
