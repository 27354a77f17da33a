#include "tools/scene/timing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace misfit::tools {
namespace {

constexpr std::size_t fewest_runs = 3;  ///< that say how slow a stretch was
constexpr int turns = 40;               ///< each about halves the error of stretches without a point in common

std::vector<double> seconds_of(const PointResult& result, double (SceneSeconds::*of)() const) {
  std::vector<double> values;
  for (const SceneSeconds& run : result.runs) values.push_back((run.*of)());
  return values;
}

double whole(const SceneSeconds& run) {
  return run.image() + run.predict();
}

/// The noise of a result by its own runs.
double own_noise(const PointResult& result, double (SceneSeconds::*seconds)() const) {
  std::vector<double> deviation = seconds_of(result, seconds);
  const double middle = median(deviation);
  for (double& d : deviation) d = std::abs(d - middle);
  constexpr double sigma_over_deviation = 1.4826;  // of a normal distribution, as is the 1.25
  return 1.25 * sigma_over_deviation * median(deviation) / (middle * std::sqrt(static_cast<double>(deviation.size())));
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::map<int, double> slowness(const std::vector<PointResult>& results) {
  std::map<int, double> slow;
  for (const PointResult& r : results)
    for (const SceneSeconds& run : r.runs) slow[run.stretch] = 1;
  for (int turn = 0; turn < turns; ++turn) {
    std::map<std::string, std::vector<double>> works;
    std::map<int, std::vector<double>> stretches;
    std::vector<double> known;
    for (const PointResult& r : results)
      for (const SceneSeconds& run : r.runs) works[r.work].push_back(whole(run) / slow[run.stretch]);
    for (const PointResult& r : results) {
      if (r.runs.empty()) continue;
      const double usual = median(works[r.work]);
      for (const SceneSeconds& run : r.runs) stretches[run.stretch].push_back(whole(run) / usual);
    }
    std::erase_if(stretches, [](const auto& stretch) { return stretch.second.size() < fewest_runs; });
    for (const auto& [stretch, ratios] : stretches) {
      slow[stretch] = median(ratios);
      known.insert(known.end(), ratios.size(), slow[stretch]);
    }
    const double middle = median(known);
    for (const auto& [stretch, ratios] : stretches) slow[stretch] /= middle;
  }
  return slow;
}

std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results) {
  const std::map<int, double> slow = slowness(results);
  std::map<std::string, std::vector<SceneSeconds>> runs;
  for (const PointResult& r : results)
    for (SceneSeconds run : r.runs) {
      for (double SceneSeconds::*stage :
           {&SceneSeconds::grid, &SceneSeconds::fft, &SceneSeconds::degrid, &SceneSeconds::predict_fft})
        run.*stage /= slow.at(run.stretch);
      runs[r.work].push_back(run);
    }
  std::vector<PointResult> found;
  for (const PointResult& r : results) {
    if (r.runs.empty()) continue;
    found.push_back(r);
    found.back().runs = runs[r.work];
  }
  return found;
}

double image_seconds(const PointResult& result) {
  return median(seconds_of(result, &SceneSeconds::image));
}

double predict_seconds(const PointResult& result) {
  return median(seconds_of(result, &SceneSeconds::predict));
}

double spread(const PointResult& result) {
  const std::vector<double> seconds = seconds_of(result, &SceneSeconds::image);
  const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
  return (*most - *least) / median(seconds);
}

std::vector<double> time_noise(const std::vector<PointResult>& results, double (SceneSeconds::*seconds)() const) {
  std::vector<double> noise;
  for (const PointResult& r : results) noise.push_back(own_noise(r, seconds));
  const double middle = median(noise);
  for (double& n : noise) n = std::max(n, middle);
  return noise;
}

}  // namespace misfit::tools
