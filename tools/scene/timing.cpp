#include "tools/scene/timing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace misfit::tools {
namespace {

std::vector<double> seconds_of(const PointResult& result, double (SceneSeconds::*of)() const) {
  std::vector<double> values;
  for (const SceneSeconds& run : result.runs) values.push_back((run.*of)());
  return values;
}

/// Of a result alone.
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

std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results) {
  std::map<std::string, std::vector<SceneSeconds>> runs;
  for (const PointResult& r : results) runs[r.work].insert(runs[r.work].end(), r.runs.begin(), r.runs.end());
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
