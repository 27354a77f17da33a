#include "tools/scene/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace misfit::tools {

double distinct_ratio(const CostAndError& a, const CostAndError& b) {
  constexpr double most = 0.1;
  return 1 + 2 * std::hypot(std::min(a.noise, most), std::min(b.noise, most));
}

std::vector<bool> pareto_front(const std::vector<CostAndError>& of) {
  std::vector<std::size_t> by_cost(of.size());
  std::iota(by_cost.begin(), by_cost.end(), std::size_t{0});
  std::stable_sort(by_cost.begin(), by_cost.end(), [&](std::size_t a, std::size_t b) {
    return of[a].cost != of[b].cost ? of[a].cost < of[b].cost : of[a].error < of[b].error;
  });
  std::vector<bool> front(of.size());
  double least = std::numeric_limits<double>::infinity();
  for (auto first = by_cost.begin(); first != by_cost.end();) {
    const auto adds = [&](std::size_t i) { return std::isfinite(of[i].cost) && of[i].error < least; };
    first = std::find_if(first, by_cost.end(), adds);
    if (first == by_cost.end()) break;
    auto best = first;
    const auto as_cheap = [&](std::size_t i) { return of[i].cost <= distinct_ratio(of[i], of[*first]) * of[*first].cost; };
    for (auto i = first; i != by_cost.end() && as_cheap(*i); ++i)
      if (of[*i].error < of[*best].error) best = i;
    front[*best] = true;
    least = of[*best].error;
    first = std::next(best);
  }
  return front;
}

}  // namespace misfit::tools
