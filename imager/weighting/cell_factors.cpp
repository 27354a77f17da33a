#include "imager/weighting/cell_factors.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

/// Rows of a half plane that are sums over `2 reach + 1` neighbours in u and v of another's.
class BoxSums {
 public:
  BoxSums(const UvDensity& density, int reach)
      : cells_(density.cells()), reach_(reach), weight_(density.weights()), along_u_(sums_along_u()) {}

  double at(int row, int column) const {
    double sum = 0;
    for (int r = row - reach_; r <= row + reach_; ++r) sum += along_u(r, column);
    return sum;
  }

 private:
  /// In the half below v = 0, the conjugate's.
  double along_u(int row, int column) const {
    if (row < 0) {
      row = -1 - row;
      column = cells_.conjugate_column(column);
    }
    if (row >= cells_.rows() || column < 0 || column >= cells_.columns()) return 0;
    return along_u_[index(row, column)];
  }
  std::vector<double> sums_along_u() const {
    std::vector<double> sums(weight_.size());
    for (int row = 0; row < cells_.rows(); ++row)
      for (int column = 0; column < cells_.columns(); ++column)
        for (int c = std::max(0, column - reach_); c <= std::min(cells_.columns() - 1, column + reach_); ++c)
          sums[index(row, column)] += weight_[index(row, c)];
    return sums;
  }
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_.columns()) + static_cast<std::size_t>(column);
  }

  const UvCells& cells_;
  const int reach_;
  const std::vector<double>& weight_;
  const std::vector<double> along_u_;
};

}  // namespace

std::vector<float> uniform_factors(const UvDensity& density, int reach) {
  const std::vector<double>& weight = density.weights();
  std::vector<float> factor(weight.size());
  if (reach == 0) {
    for (std::size_t k = 0; k < weight.size(); ++k) factor[k] = weight[k] > 0 ? static_cast<float>(1 / weight[k]) : 0;
    return factor;
  }
  const BoxSums box(density, reach);
  std::size_t k = 0;
  for (int row = 0; row < density.cells().rows(); ++row)
    for (int column = 0; column < density.cells().columns(); ++column, ++k)
      if (weight[k] > 0) factor[k] = static_cast<float>(1 / box.at(row, column));
  return factor;
}

double briggs_f2(const UvDensity& density, double robust) {
  double sum = 0, square = 0;
  for (const double weight : density.weights()) {
    sum += weight;
    square += weight * weight;
  }
  const double numerator = 5 * std::pow(10, -robust);
  return square > 0 ? numerator * numerator * sum / square : 0;
}

std::vector<float> briggs_abs_factors(const UvDensity& density, double robust, double noise_jy) {
  std::vector<float> factor;
  for (const double weight : density.weights())
    factor.push_back(weight > 0 ? static_cast<float>(1 / (4 * weight * robust * robust + 2 * noise_jy * noise_jy)) : 0);
  return factor;
}

std::vector<float> briggs_factors(const UvDensity& density, double f2) {
  const std::vector<double>& weight = density.weights();
  std::vector<float> factor(weight.size());
  for (std::size_t k = 0; k < weight.size(); ++k)
    if (weight[k] > 0) factor[k] = static_cast<float>(1 / (1 + weight[k] * f2));
  return factor;
}

}  // namespace misfit::imager
