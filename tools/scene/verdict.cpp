#include "tools/scene/verdict.h"

#include <algorithm>
#include <cmath>

#include "tools/base/numbers.h"
#include "tools/scene/timing.h"

namespace misfit::tools {
namespace {

constexpr double too_noisy = 0.1;  ///< points that differ by a quarter cannot be told apart then

bool is_ours(const PointResult& r) {
  return r.point.kernel == "least-misfit" || r.point.kernel == "minimax";
}

/// "kaiser-bessel of width 6 at 2·10⁻⁵, where …": the quickest of our points as exact, and how much longer it takes.
std::string words_on(std::size_t other, const std::vector<PointResult>& results, const std::vector<CostAndError>& costs) {
  const PointResult& r = results[other];
  std::size_t quickest = other;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (is_ours(results[i]) && costs[i].error <= costs[other].error &&
        (quickest == other || costs[i].cost < costs[quickest].cost))
      quickest = i;
  std::string words = r.point.kernel + " of width " + std::to_string(r.width) + " at " + power_of_ten(costs[other].error, 2) +
                      ", where the next least-misfit or minimax point as exact ";
  if (quickest == other) return words + "was not among the points";
  const double ratio = costs[quickest].cost / costs[other].cost;
  const double noise = (distinct_ratio(costs[quickest], costs[other]) - 1) / 2;
  return words + "takes " + significant(ratio, 3) + " ± " + significant(noise * ratio, 1) + " times as long";
}

double median_noise(const std::vector<CostAndError>& costs) {
  std::vector<double> noise;
  for (const CostAndError& c : costs) noise.push_back(c.noise);
  return median(noise);
}

}  // namespace

std::vector<CostAndError> image_costs(const std::vector<PointResult>& results) {
  const std::vector<double> noise = time_noise(results, &SceneSeconds::image);
  std::vector<CostAndError> costs;
  for (const PointResult& r : results) costs.push_back({image_seconds(r), r.errors.rms, noise[costs.size()]});
  return costs;
}

std::vector<CostAndError> predict_costs(const std::vector<PointResult>& results) {
  const std::vector<double> noise = time_noise(results, &SceneSeconds::predict);
  std::vector<CostAndError> costs;
  for (const PointResult& r : results) costs.push_back({predict_seconds(r), r.errors.predict_rms, noise[costs.size()]});
  return costs;
}

std::string words_on_noise(const std::vector<PointResult>& results) {
  return "Times are known to " + significant(100 * median_noise(image_costs(results)), 2) +
         " % (one standard error, in the middle of all points); points that differ by less than two standard errors of their "
         "ratio count as equal.";
}

std::string verdict_on(const std::vector<PointResult>& results) {
  const std::vector<CostAndError> costs = image_costs(results);
  if (median_noise(costs) > too_noisy)
    return "Times are too uncertain to say which kernel is worth its time: to " + significant(100 * median_noise(costs), 2) +
           " %, where a tenth or less is needed. Run it on a quiet machine.";
  const std::vector<bool> front = pareto_front(costs);
  int ours = 0;
  std::string others;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!front[i] || costs[i].error > 1e-3 || costs[i].error < 1e-7) continue;
    if (is_ours(results[i]))
      ++ours;
    else
      others += (others.empty() ? "" : "; ") + words_on(i, results, costs);
  }
  if (ours == 0 && others.empty()) return "No point of the front lies between 10⁻³ and 10⁻⁷.";
  if (std::all_of(results.begin(), results.end(), is_ours))
    return "No kernels but least-misfit and minimax were measured: nothing is compared.";
  const std::string count =
      std::to_string(ours) + (ours == 1 ? " least-misfit or minimax point" : " least-misfit and minimax points");
  if (others.empty()) return "From 10⁻³ to 10⁻⁷ the front consists of " + count + " alone.";
  return "From 10⁻³ to 10⁻⁷ the front has " + count + ", and others: " + others + ".";
}

}  // namespace misfit::tools
