#include "tools/kernel_report/evaluation_speed.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>

namespace misfit::tools {
namespace {

double time_ns(const kernels::Evaluation& way, const Eigen::VectorXd& t) {
  const auto start = std::chrono::steady_clock::now();
  const double total = way.total(t);
  const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
  if (!std::isfinite(total)) throw std::logic_error("taps of " + way.name + " are not finite");  // uses the total, too
  return taken.count();
}

}  // namespace

std::vector<double> nanoseconds_a_visibility(const std::vector<kernels::Evaluation>& ways, const SpeedOptions& options) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within(-0.5, 0.5);
  const Eigen::VectorXd t = Eigen::VectorXd::NullaryExpr(2 * options.visibilities, [&] { return within(random); });
  std::vector<std::vector<double>> times(ways.size());
  for (int run = 0; run < options.runs; ++run)
    for (std::size_t i = 0; i < ways.size(); ++i) times[i].push_back(time_ns(ways[i], t) / options.visibilities);
  std::vector<double> medians;
  for (std::vector<double>& of_way : times) {
    const auto middle = of_way.begin() + static_cast<std::ptrdiff_t>(of_way.size() / 2);
    std::nth_element(of_way.begin(), middle, of_way.end());
    medians.push_back(*middle);
  }
  return medians;
}

}  // namespace misfit::tools
