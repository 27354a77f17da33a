#include "tools/drawing/ticks.h"

#include <algorithm>
#include <cmath>

namespace misfit::tools {
namespace {

constexpr double rounding = 1e-9;  // so that limits are ticks where they are round

std::vector<double> powers_of_ten(double low, double high, const std::vector<double>& factors, int every) {
  std::vector<double> values;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  for (int power = first; std::pow(10.0, power) <= high * (1 + rounding); ++power) {
    if (power % every != 0) continue;
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, power);
      if (value >= low * (1 - rounding) && value <= high * (1 + rounding)) values.push_back(value);
    }
  }
  return values;
}

}  // namespace

double round_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1, 2, 5})
    if (rough < 1.5 * factor * decade) return factor * decade;
  return 10 * decade;
}

std::vector<double> linear_ticks(double low, double high, int about) {
  const double step = round_step((high - low) / about);
  std::vector<double> values;
  for (double n = std::ceil(low / step - rounding); n * step <= high + rounding * step; ++n) values.push_back(n * step);
  return values;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  std::vector<double> values = powers_of_ten(low, high, {1}, 1);
  if (values.size() < 3) values = powers_of_ten(low, high, {1, 2, 5}, 1);
  if (values.size() < 3) return linear_ticks(low, high, 5);  // 3 to 8 of them
  for (int every = 2; values.size() > 8; ++every) values = powers_of_ten(low, high, {1}, every);
  return values;
}

}  // namespace misfit::tools
