#include "imager/weighting/cell_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::imager {
namespace {

/// Sums of value(k), which belongs to cell k and its conjugate, over boxes of n = 2 reach + 1 columns and rows. Any n values in
/// a row are the tail of one block of n and the head of the next. The sums of tails and heads take additions whose number does
/// not grow with n, and nothing is subtracted, so that small sums beside large ones stay exact (van Herk 1992, Pattern
/// Recognition Letters 13, 517, finds maxima so).
template <typename Value>
class BoxSums {
 public:
  BoxSums(const UvCells& cells, int reach, Value value)
      : cells_(cells),
        reach_(reach),
        value_(std::move(value)),
        columns_(static_cast<std::size_t>(cells.columns())),
        line_(columns_ + 2 * static_cast<std::size_t>(reach)),
        along_u_(columns_),
        head_(columns_),
        tail_(static_cast<std::size_t>(box()), std::vector<double>(columns_)),
        sum_(columns_) {}

  /// The sums about the cells of the next row, from row 0 on. [column]
  const std::vector<double>& next_row() {
    const int in_block = row_ % box();
    if (in_block == 0)
      begin_block();
    else
      add(along_u(row_ + reach_), head_);
    ++row_;
    sum_ = tail_[static_cast<std::size_t>(in_block)];
    add(head_, sum_);
    return sum_;
  }

 private:
  int box() const { return 2 * reach_ + 1; }

  void begin_block() {
    std::fill(head_.begin(), head_.end(), 0);
    for (int i = box() - 1; i >= 0; --i) {
      std::vector<double>& tail = tail_[static_cast<std::size_t>(i)];
      tail = along_u(row_ - reach_ + i);
      if (i + 1 < box()) add(tail_[static_cast<std::size_t>(i) + 1], tail);
    }
  }

  /// The sums over n columns about each cell of a row, which may lie below v = 0 or beyond the plane.
  const std::vector<double>& along_u(int row) {
    fill_line(row);
    const auto n = static_cast<std::size_t>(box());
    for (std::size_t begin = 0; begin < columns_; begin += n) {
      const std::size_t end = std::min(begin + n, columns_);
      double tail = 0, head = 0;
      for (std::size_t i = begin + n; i-- > begin;) {
        tail += line_[i];
        if (i < end) along_u_[i] = tail;
      }
      for (std::size_t i = begin + 1; i < end; ++i) {
        head += line_[i + n - 1];
        along_u_[i] += head;
      }
    }
    return along_u_;
  }

  /// The values of a row from `reach` columns before its first to as many behind its last.
  void fill_line(int row) {
    const bool lower_half = row < 0;
    const int held = lower_half ? -1 - row : row;
    std::fill(line_.begin(), line_.end(), 0);
    if (held >= cells_.rows()) return;
    const std::size_t first = static_cast<std::size_t>(held) * columns_;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const int at = static_cast<int>(i) - reach_, column = lower_half ? cells_.conjugate_column(at) : at;
      if (column >= 0 && column < cells_.columns()) line_[i] = value_(first + static_cast<std::size_t>(column));
    }
  }

  static void add(const std::vector<double>& more, std::vector<double>& sum) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
  }

  const UvCells& cells_;
  const int reach_;
  const Value value_;
  const std::size_t columns_;
  int row_ = 0;
  std::vector<double> line_;     ///< a row, with `reach` columns more on either side
  std::vector<double> along_u_;  ///< [column]
  std::vector<double> head_;
  std::vector<std::vector<double>> tail_;  ///< [row in the block][column]
  std::vector<double> sum_;
};

}  // namespace

std::vector<float> uniform_factors(const UvDensity& density, int reach) {
  const std::vector<double>& weight = density.weights();
  std::vector<float> factor(weight.size());
  if (reach == 0) {
    for (std::size_t k = 0; k < weight.size(); ++k) factor[k] = weight[k] > 0 ? static_cast<float>(1 / weight[k]) : 0;
    return factor;
  }
  BoxSums box(density.cells(), reach, [&](std::size_t cell) { return weight[cell]; });
  for (std::size_t k = 0; k < weight.size();)
    for (const double sum : box.next_row()) {
      if (weight[k] > 0) factor[k] = static_cast<float>(1 / sum);
      ++k;
    }
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
  factor.reserve(density.weights().size());
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

std::vector<float> rank_filtered(const UvCells& cells, const std::vector<float>& factor, const RankFilter& filter) {
  BoxSums factors(cells, filter.reach, [&](std::size_t cell) { return double{factor[cell]}; });
  BoxSums filled(cells, filter.reach, [&](std::size_t cell) { return factor[cell] > 0 ? 1. : 0.; });
  std::vector<float> filtered(factor.size());
  for (std::size_t k = 0; k < factor.size();) {
    const std::vector<double>&sum = factors.next_row(), &count = filled.next_row();
    for (std::size_t column = 0; column < sum.size(); ++column, ++k)
      if (factor[k] > 0) filtered[k] = std::min(factor[k], static_cast<float>(filter.level * sum[column] / count[column]));
  }
  return filtered;
}

}  // namespace misfit::imager
