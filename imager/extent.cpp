#include "imager/extent.h"

#include <algorithm>
#include <cmath>

#include "imager/constants.h"

namespace misfit::imager {
namespace {

/// 1 − n, with n = 0 beyond the horizon.
double one_minus_n(DirectionCosines at) {
  return beyond_horizon(at) ? 1 : -n_minus_1(at);
}

}  // namespace

void UvwExtent::add(const VisibilityBlock& block) {
  std::size_t i = 0;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    double top_hz = 0;
    double weighted_square_hz = 0;
    for (const double frequency : block.frequency_hz) {
      const double w = block.weight[i++];
      if (w == 0) continue;
      top_hz = std::max(top_hz, frequency);
      weight += w;
      weighted_square_hz += w * frequency * frequency;
    }
    if (top_hz == 0) continue;
    const double* uvw_m = &block.uvw_m[3 * row];
    const double per_m = top_hz / speed_of_light_m_s;
    max_abs_u = std::max(max_abs_u, std::abs(uvw_m[0]) * per_m);
    max_abs_v = std::max(max_abs_v, std::abs(uvw_m[1]) * per_m);
    max_abs_w = std::max(max_abs_w, std::abs(uvw_m[2]) * per_m);
    weighted_w_square += weighted_square_hz * (uvw_m[2] / speed_of_light_m_s) * (uvw_m[2] / speed_of_light_m_s);
  }
}

NeglectedPhase neglected_w_phase(const UvwExtent& extent, const ImageGeometry& geometry) {
  const double corner = largest_drop(geometry);
  // n is so smooth that a grid of 256 × 256 pixels has its mean.
  const int row_step = std::max(1, geometry.height / 256);
  const int column_step = std::max(1, geometry.width / 256);
  double square = 0;
  int pixels = 0;
  for (int row = 0; row < geometry.height; row += row_step)
    for (int column = 0; column < geometry.width; column += column_step, ++pixels) {
      const double x = one_minus_n(geometry.at(row, column));
      square += x * x;
    }
  const double rms_w = extent.weight == 0 ? 0 : std::sqrt(extent.weighted_w_square / extent.weight);
  return {2 * pi * extent.max_abs_w * corner, 2 * pi * rms_w * std::sqrt(square / pixels)};
}

}  // namespace misfit::imager
