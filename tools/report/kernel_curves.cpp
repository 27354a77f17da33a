#include "tools/report/kernel_curves.h"

#include <algorithm>
#include <limits>

#include "tools/base/numbers.h"

namespace misfit::tools {

using kernels::TapFunction;

const kernels::LeastMisfit& SolvedKernels::operator()(int width, double x0) {
  const auto found = solved_.find({width, x0});
  if (found != solved_.end()) return found->second;
  return solved_.emplace(std::pair{width, x0}, kernels::solve_least_misfit(width, x0)).first->second;
}

Series curve(const std::string& label, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  return {.label = label, .x = {x.begin(), x.end()}, .y = {y.begin(), y.end()}};
}

Series map_error_curve(const std::string& label, const TapFunction& taps, const kernels::JudgeOptions& options) {
  const Eigen::VectorXd x = places(0.5);
  return curve(label, x, kernels::map_error(taps, x, options));
}

Series correction_curve(const std::string& label, const TapFunction& taps, double x0) {
  const Eigen::VectorXd x = places(x0);
  return curve(label, x, kernels::optimal_correction(taps, x));
}

Series function_curve(const std::string& label, const TapFunction& taps) {
  constexpr int points_of_cell = 33;
  const auto width = static_cast<int>(taps(0).size());
  Series result{.label = label, .x = {}, .y = {}};
  for (int r = width / 2; r < width; ++r) {
    const double middle = r - (width - 1) / 2.0;  // the cell's: u = middle − t
    for (const double t : Eigen::VectorXd::LinSpaced(points_of_cell, std::min(middle, 0.5), -0.5)) {
      result.x.push_back(middle - t);
      result.y.push_back(taps(t)[r]);
    }
    result.x.push_back(middle + 0.5);
    result.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

Eigen::VectorXd places(double to) {
  return Eigen::VectorXd::LinSpaced(501, 0, to);
}

Figure map_error_figure(const std::string& name, const std::string& title, double from, double to) {
  return {.name = name,
          .title = title,
          .caption = "",
          .x = {.label = "x, offset from the phase centre / size of the FFT", .from = 0, .to = 0.5},
          .y = {.label = "map error ℓ(x)", .logarithmic = true, .from = from, .to = to},
          .series = {}};
}

std::string x0_label(double x0) {
  return "x₀ = " + significant(x0, 3);
}

std::string width_label(int width) {
  return "W = " + std::to_string(width);
}

}  // namespace misfit::tools
