#include "imager/cube/row_order.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::imager {
namespace {

constexpr int bits = 16;  // places along each side of the square: far more than a grid has tiles

/// How far along the curve a place lies. Each square's curve visits its four quarters in the shape of a U; that of the first
/// quarter is transposed, that of the last one transposed and turned by half a turn, so that ends meet.
std::uint32_t along_curve(std::uint32_t x, std::uint32_t y) {
  std::uint32_t distance = 0;
  bool transposed = false, turned = false;
  for (int bit = bits - 1; bit >= 0; --bit) {
    bool right = ((x >> bit) & 1) != 0, upper = ((y >> bit) & 1) != 0;
    if (transposed) std::swap(right, upper);
    if (turned) {
      right = !right;
      upper = !upper;
    }
    const std::uint32_t quarter = right ? (upper ? 2 : 3) : (upper ? 1 : 0);
    distance = 4 * distance + quarter;
    if (quarter == 0 || quarter == 3) transposed = !transposed;
    if (quarter == 3) turned = !turned;
  }
  return distance;
}

}  // namespace

std::vector<std::uint32_t> order_in_uv(const std::vector<double>& uvw_m) {
  const std::size_t rows = uvw_m.size() / 3;
  double reach_m = 0;
  for (std::size_t row = 0; row < rows; ++row)
    for (const double x : {uvw_m[3 * row], uvw_m[3 * row + 1]})
      if (std::isfinite(x)) reach_m = std::max(reach_m, std::abs(x));
  const double per_m = reach_m > 0 ? ((1 << bits) - 1) / reach_m : 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> place(rows);  // along the curve, row
  for (std::size_t row = 0; row < rows; ++row) {
    const double sign = uvw_m[3 * row + 1] < 0 ? -1 : 1;
    const double u = sign * uvw_m[3 * row] * per_m, v = sign * uvw_m[3 * row + 1] * per_m;
    place[row].second = static_cast<std::uint32_t>(row);
    if (!std::isfinite(u) || !std::isfinite(v)) continue;
    place[row].first = along_curve(static_cast<std::uint32_t>(0.5 * (u + (1 << bits) - 1)), static_cast<std::uint32_t>(v));
  }
  std::sort(place.begin(), place.end());
  std::vector<std::uint32_t> order(rows);
  for (std::size_t i = 0; i < rows; ++i) order[i] = place[i].second;
  return order;
}

}  // namespace misfit::imager
