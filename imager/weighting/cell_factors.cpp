#include "imager/weighting/cell_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::imager {
namespace {

/// Sums of values, each of which belongs to a cell and its conjugate, over boxes of n = 2 reach + 1 columns and rows. Any n
/// values in a row are the tail of one block of n and the head of the next. The sums of tails and heads take additions whose
/// number does not grow with n, and nothing is subtracted, so that small sums beside large ones stay exact (van Herk 1992,
/// Pattern Recognition Letters 13, 517, finds maxima so).
template <typename Cells, typename Value>
class BoxSums {
 public:
  /// Sums value(w), where w is what `cells` has for cell k.
  BoxSums(const Cells& cells, int reach, Value value)
      : cells_(cells),
        reach_(reach),
        value_(std::move(value)),
        columns_(static_cast<std::size_t>(cells.cells().columns())),
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
    const UvCells& plane = cells_.cells();
    const bool lower_half = row < 0;
    const int held = lower_half ? -1 - row : row;
    std::fill(line_.begin(), line_.end(), 0);
    if (held >= plane.rows()) return;
    const auto* const of_row = cells_.row(held, room_);
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const int at = static_cast<int>(i) - reach_, column = lower_half ? plane.conjugate_column(at) : at;
      if (column >= 0 && column < plane.columns()) line_[i] = value_(of_row[column]);
    }
  }

  static void add(const std::vector<double>& more, std::vector<double>& sum) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
  }

  const Cells& cells_;
  const int reach_;
  const Value value_;
  const std::size_t columns_;
  int row_ = 0;
  std::vector<typename Cells::value_type> room_;  ///< for a row as it is held
  std::vector<double> line_;                      ///< a row, with `reach` columns more on either side
  std::vector<double> along_u_;                   ///< [column]
  std::vector<double> head_;
  std::vector<std::vector<double>> tail_;  ///< [row in the block][column]
  std::vector<double> sum_;
};

}  // namespace

template <template <typename> class Cells>
Cells<float> uniform_factors(const Cells<double>& weight, int reach) {
  if (reach == 0) return weight.map([](double w) { return 1 / w; });
  Cells<float> factor(weight.cells());
  std::vector<double> room;
  BoxSums box(weight, reach, [](double w) { return w; });
  for (int row = 0; row < weight.cells().rows(); ++row) {
    const std::vector<double>& sum = box.next_row();
    const double* const of_row = weight.row(row, room);
    for (int column = 0; column < weight.cells().columns(); ++column)
      if (of_row[column] > 0) factor.set(row, column, static_cast<float>(1 / sum[static_cast<std::size_t>(column)]));
  }
  return factor;
}

template <template <typename> class Cells>
double briggs_f2(const Cells<double>& weight, double robust) {
  double sum = 0, square = 0;
  weight.for_each([&](double w) {
    sum += w;
    square += w * w;
  });
  const double numerator = 5 * std::pow(10, -robust);
  return square > 0 ? numerator * numerator * sum / square : 0;
}

template <template <typename> class Cells>
Cells<float> briggs_abs_factors(const Cells<double>& weight, double robust, double noise_jy) {
  return weight.map([=](double w) { return 1 / (4 * w * robust * robust + 2 * noise_jy * noise_jy); });
}

template <template <typename> class Cells>
Cells<float> briggs_factors(const Cells<double>& weight, double f2) {
  return weight.map([f2](double w) { return 1 / (1 + w * f2); });
}

template <template <typename> class Cells>
Cells<float> rank_filtered(const Cells<float>& factor, const RankFilter& filter) {
  BoxSums factors(factor, filter.reach, [](float f) { return double{f}; });
  BoxSums filled(factor, filter.reach, [](float f) { return f > 0 ? 1. : 0.; });
  Cells<float> filtered(factor.cells());
  std::vector<float> room;
  for (int row = 0; row < factor.cells().rows(); ++row) {
    const std::vector<double>&sum = factors.next_row(), &count = filled.next_row();
    const float* const of_row = factor.row(row, room);
    for (int column = 0; column < factor.cells().columns(); ++column) {
      const auto c = static_cast<std::size_t>(column);
      const float f = of_row[c];
      if (f > 0) filtered.set(row, column, std::min(f, static_cast<float>(filter.level * sum[c] / count[c])));
    }
  }
  return filtered;
}

template DenseCells<float> uniform_factors(const DenseCells<double>&, int);
template DenseCells<float> briggs_factors(const DenseCells<double>&, double);
template DenseCells<float> briggs_abs_factors(const DenseCells<double>&, double, double);
template DenseCells<float> rank_filtered(const DenseCells<float>&, const RankFilter&);
template double briggs_f2(const DenseCells<double>&, double);
template CellTiles<float> uniform_factors(const CellTiles<double>&, int);
template CellTiles<float> briggs_factors(const CellTiles<double>&, double);
template CellTiles<float> briggs_abs_factors(const CellTiles<double>&, double, double);
template CellTiles<float> rank_filtered(const CellTiles<float>&, const RankFilter&);
template double briggs_f2(const CellTiles<double>&, double);

}  // namespace misfit::imager
