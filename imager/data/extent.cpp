#include "imager/data/extent.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
void WSpread::add(const VisibilityBlock& block) {
  if (block.channels() == 1) return add_rows(block);
  std::vector<double> per_m_square;
  for (const double frequency : block.frequency_hz) per_m_square.push_back(std::pow(frequency / speed_of_light_m_s, 2));
  const float* sample = block.weight.data();
  for (std::size_t row = 0; row < block.rows(); ++row) {
    double row_weight = 0;
    double weighted_per_m_square = 0;
    for (const double square : per_m_square) {
      const double w = *sample++;
      row_weight += w;
      weighted_per_m_square += w * square;
    }
    if (row_weight == 0) continue;  // UVW may not be finite
    weight += row_weight;
    weighted_w_square += weighted_per_m_square * std::pow(block.uvw_m[3 * row + 2], 2);
  }
}

/// Adds rows of one channel, in lanes, so that no addition waits for the one before.
void WSpread::add_rows(const VisibilityBlock& block) {
  constexpr std::size_t lanes = 4;
  double sum[lanes] = {}, sum_w_square[lanes] = {};
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const double w = block.weight[row], w_m = w == 0 ? 0 : block.uvw_m[3 * row + 2];  // UVW may not be finite
    sum[row % lanes] += w;
    sum_w_square[row % lanes] += w * w_m * w_m;
  }
  const double per_m = block.frequency_hz.front() / speed_of_light_m_s;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    weight += sum[lane];
    weighted_w_square += sum_w_square[lane] * per_m * per_m;
  }
}

WSpread& WSpread::operator+=(const WSpread& other) {
  weight += other.weight;
  weighted_w_square += other.weighted_w_square;
  return *this;
}

double max_w_phase_rad(double max_abs_w, const ImageGeometry& geometry) {
  return 2 * pi * max_abs_w * largest_drop(geometry);
}

NeglectedPhase neglected_w_phase(const UvwReach& reach, const WSpread& spread, const ImageGeometry& geometry) {
  // n is so smooth that a grid of 256 × 256 pixels has its mean.
  const int row_step = std::max(1, geometry.height / 256);
  const int column_step = std::max(1, geometry.width / 256);
  double square = 0;
  int pixels = 0;
  for (int row = 0; row < geometry.height; row += row_step)
    for (int column = 0; column < geometry.width; column += column_step, ++pixels) {
      const double x = drop(geometry.at(row, column));
      square += x * x;
    }
  const double rms_w = spread.weight == 0 ? 0 : std::sqrt(spread.weighted_w_square / spread.weight);
  return {max_w_phase_rad(reach.max_abs_w, geometry), 2 * pi * rms_w * std::sqrt(square / pixels)};
}

}  // namespace misfit::imager
