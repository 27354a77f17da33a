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

/// "kaiser-bessel of width 6 at 2·10⁻⁵, where …": with the quickest of our points that is as exact, within noise, and how much
/// longer it takes.
std::string words_on(std::size_t other, const std::vector<PointResult>& results, const std::vector<CostAndError>& costs) {
  const PointResult& r = results[other];
  const CostAndError& its = costs[other];
  std::size_t quickest = other;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (is_ours(results[i]) && costs[i].error <= distinct_ratio(costs[i].error_noise, its.error_noise) * its.error &&
        (quickest == other || costs[i].cost < costs[quickest].cost))
      quickest = i;
  std::string words = r.point.kernel + " of width " + std::to_string(r.width) + " at " + power_of_ten(its.error, 2) +
                      ", where the next least-misfit or minimax point as exact ";
  if (quickest == other) return words + "was not among the points";
  const double ratio = costs[quickest].cost / its.cost;
  const double clear = distinct_ratio(costs[quickest].cost_noise, its.cost_noise);
  const std::string times = significant(ratio, 3) + " ± " + significant((clear - 1) / 2 * ratio, 1) + " times";
  return words + (ratio > clear ? "takes " + times + " as long" : "takes as long but for noise, " + times);
}

double median_of(const std::vector<CostAndError>& costs, double CostAndError::*number) {
  std::vector<double> values;
  for (const CostAndError& c : costs) values.push_back(c.*number);
  return median(values);
}

std::string percent(double part) {
  return significant(100 * part, 2) + " %";
}

}  // namespace

std::vector<CostAndError> image_costs(const std::vector<PointResult>& results) {
  const std::vector<double> noise = time_noise(results, &SceneSeconds::image);
  std::vector<CostAndError> costs;
  for (const PointResult& r : results)
    costs.push_back({image_seconds(r), r.errors.rms, noise[costs.size()], r.errors.rms_noise});
  return costs;
}

std::vector<CostAndError> predict_costs(const std::vector<PointResult>& results) {
  const std::vector<double> noise = time_noise(results, &SceneSeconds::predict);
  std::vector<CostAndError> costs;
  for (const PointResult& r : results)
    costs.push_back({predict_seconds(r), r.errors.predict_rms, noise[costs.size()], r.errors.predict_noise});
  return costs;
}

std::string words_on_noise(const std::vector<PointResult>& results) {
  const std::vector<CostAndError> costs = image_costs(results);
  return "Times are known to " + percent(median_of(costs, &CostAndError::cost_noise)) + ", RMS errors to " +
         percent(median_of(costs, &CostAndError::error_noise)) +
         " for the choice of pixels (one standard error, in the middle of all points); points that differ by less than two "
         "standard errors of their ratio count as equal.";
}

std::string words_on_speed(const std::vector<PointResult>& results) {
  const std::map<int, double> slow = slowness(results);
  if (slow.empty()) return "";
  const auto [least, most] =
      std::minmax_element(slow.begin(), slow.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return "All points were run by turns, in another order each time; the machine was up to " +
         significant(most->second / least->second, 2) + " times as fast at one time as at another, which is taken out.";
}

std::string verdict_on(const std::vector<PointResult>& results) {
  const std::vector<CostAndError> costs = image_costs(results);
  const double noise = median_of(costs, &CostAndError::cost_noise);
  if (noise > too_noisy)
    return "Times are too uncertain to say which kernel is worth its time: to " + percent(noise) +
           ", where a tenth or less is needed. Run it on a quiet machine.";
  const std::vector<bool> front = pareto_front(costs);
  int ours = 0;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!front[i] || costs[i].error > 1e-3 || costs[i].error < 1e-7) continue;
    if (is_ours(results[i]))
      ++ours;
    else
      others.push_back(words_on(i, results, costs));
  }
  if (ours == 0 && others.empty()) return "No point of the front lies between 10⁻³ and 10⁻⁷.";
  if (std::all_of(results.begin(), results.end(), is_ours))
    return "No kernels but least-misfit and minimax were measured: nothing is compared.";
  std::string named;
  for (const std::string& other : others) named += (named.empty() ? "" : "; ") + other;
  const std::string range = "From 10⁻³ to 10⁻⁷ the front ";
  if (ours == 0) return range + "has none of least-misfit or minimax; it consists of: " + named + ".";
  const std::string count =
      std::to_string(ours) + (ours == 1 ? " least-misfit or minimax point" : " least-misfit and minimax points");
  if (others.empty()) return range + "consists of " + count + " alone.";
  return range + "has " + count + ", and " + (others.size() == 1 ? "one other: " : "others: ") + named + ".";
}

}  // namespace misfit::tools
