#include "tools/scene/pareto.h"

#include <algorithm>
#include <cmath>

namespace misfit::tools {
namespace {

/// Which of two is clearly less: negative for `a`, 0 for neither.
int clearly(double a, double b, double ratio) {
  return a * ratio < b ? -1 : b * ratio < a ? 1 : 0;
}

struct Comparison {
  int cost;
  int error;

  Comparison(const CostAndError& a, const CostAndError& b)
      : cost(clearly(a.cost, b.cost, distinct_ratio(a.cost_noise, b.cost_noise))),
        error(clearly(a.error, b.error, distinct_ratio(a.error_noise, b.error_noise))) {}
  bool covers() const { return cost <= 0 && error <= 0; }
  bool beats() const { return covers() && cost + error < 0; }
};

}  // namespace

double distinct_ratio(double noise, double other_noise) {
  return 1 + 2 * std::hypot(noise, other_noise);
}

std::vector<bool> pareto_front(const std::vector<CostAndError>& of) {
  std::vector<CostAndError> known = of;
  for (CostAndError& c : known) c.cost_noise = std::min(c.cost_noise, 0.1);
  std::vector<std::size_t> left;  // the most exact first
  for (std::size_t i = 0; i < known.size(); ++i)
    if (std::isfinite(known[i].cost) && std::isfinite(known[i].error)) left.push_back(i);
  std::stable_sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
    return known[a].error != known[b].error ? known[a].error < known[b].error : known[a].cost < known[b].cost;
  });
  std::vector<bool> front(known.size());
  while (!left.empty()) {
    const auto unbeaten = std::find_if(left.begin(), left.end(), [&](std::size_t i) {
      return std::none_of(left.begin(), left.end(), [&](std::size_t k) { return Comparison(known[k], known[i]).beats(); });
    });
    const std::size_t best = unbeaten == left.end() ? left.front() : *unbeaten;
    front[best] = true;
    std::erase_if(left, [&](std::size_t i) { return Comparison(known[best], known[i]).covers(); });
  }
  return front;
}

}  // namespace misfit::tools
