#include "imager/cube/row_order.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

constexpr int bits = 16;  // places along each side of the square: far more than a grid has tiles
constexpr std::uint32_t side = 1U << bits;

/// How far along the curve a place lies. Each square's curve visits its four quarters in the shape of a U; that of the first
/// quarter is transposed, that of the last one transposed and turned by half a turn, so that ends meet. Without branches, which
/// would all be guessed wrong half of the time.
std::uint32_t along_curve(std::uint32_t x, std::uint32_t y) {
  std::uint32_t distance = 0, transposed = 0, turned = 0;  // 0 or 1
  for (int bit = bits - 1; bit >= 0; --bit) {
    std::uint32_t right = ((x >> bit) & 1U) ^ turned, upper = ((y >> bit) & 1U) ^ turned;
    const std::uint32_t swapped = (right ^ upper) & transposed;
    right ^= swapped;
    upper ^= swapped;
    distance = 4 * distance + ((3 * right) ^ upper);
    transposed ^= 1U ^ upper;
    turned ^= right & (1U ^ upper);
  }
  return distance;
}

struct Placed {
  std::uint32_t distance;
  std::uint32_t row;
};

/// Sorts by 16 bits of the distance, stably.
void sort_by_bits(const std::vector<Placed>& from, int shift, std::vector<Placed>& to) {
  std::vector<std::uint32_t> next(side + 1);
  for (const Placed& one : from) ++next[((one.distance >> shift) & (side - 1)) + 1];
  for (std::size_t i = 0; i < side; ++i) next[i + 1] += next[i];
  for (const Placed& one : from) to[next[(one.distance >> shift) & (side - 1)]++] = one;
}

}  // namespace

std::vector<std::uint32_t> order_in_uv(const std::vector<double>& uvw_m) {
  const std::size_t rows = uvw_m.size() / 3;
  double reach_m = 0;
  for (std::size_t row = 0; row < rows; ++row)
    for (const double x : {uvw_m[3 * row], uvw_m[3 * row + 1]})
      if (std::isfinite(x)) reach_m = std::max(reach_m, std::abs(x));
  const double per_m = reach_m > 0 ? (side - 1) / reach_m : 0;
  std::vector<Placed> placed(rows), sorted(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const double sign = uvw_m[3 * row + 1] < 0 ? -per_m : per_m;
    const double u = sign * uvw_m[3 * row], v = sign * uvw_m[3 * row + 1];
    placed[row].row = static_cast<std::uint32_t>(row);
    if (!std::isfinite(u) || !std::isfinite(v)) continue;
    placed[row].distance = along_curve(static_cast<std::uint32_t>(0.5 * (u + side - 1)), static_cast<std::uint32_t>(v));
  }
  sort_by_bits(placed, 0, sorted);
  sort_by_bits(sorted, bits, placed);
  std::vector<std::uint32_t> order(rows);
  for (std::size_t i = 0; i < rows; ++i) order[i] = placed[i].row;
  return order;
}

}  // namespace misfit::imager
