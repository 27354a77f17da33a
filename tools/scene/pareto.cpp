#include "tools/scene/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace misfit::tools {

std::vector<bool> pareto_front(const std::vector<CostAndError>& of) {
  std::vector<std::size_t> by_cost(of.size());
  std::iota(by_cost.begin(), by_cost.end(), std::size_t{0});
  std::stable_sort(by_cost.begin(), by_cost.end(), [&](std::size_t a, std::size_t b) {
    return of[a].cost != of[b].cost ? of[a].cost < of[b].cost : of[a].error < of[b].error;
  });
  std::vector<bool> front(of.size());
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : by_cost) {
    if (!std::isfinite(of[i].cost) || !(of[i].error < least)) continue;
    front[i] = true;
    least = of[i].error;
  }
  return front;
}

}  // namespace misfit::tools
