#include "imager/weighting/uv_cells.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"
#include "imager/transform/sampling.h"

namespace misfit::imager {

UvCells::UvCells(const ImageGeometry& geometry)
    : width_(geometry.width), height_(geometry.height), cell_rad_(geometry.cell_rad), origin_((geometry.width + 1) / 2) {}

std::vector<double> UvCells::turns_per_m(const std::vector<double>& frequency_hz) const {
  std::vector<double> turns;
  turns.reserve(frequency_hz.size());
  for (const double frequency : frequency_hz) turns.push_back(frequency / speed_of_light_m_s * cell_rad_);
  return turns;
}

/// Locates samples, written so that the compiler makes vectors of it: samples outside are placed at 0 and marked afterwards.
template <typename Number>
void UvCells::locate(const double* uvw_m, const std::vector<double>& turns_per_m, const Number& number,
                     std::uint32_t* found) const {
  if (!std::isfinite(uvw_m[0]) || !std::isfinite(uvw_m[1])) {
    std::fill_n(found, turns_per_m.size(), outside);
    return;
  }
  const bool other_half = uvw_m[1] < 0 || (uvw_m[1] == 0 && uvw_m[0] < 0);
  const double u_m = other_half ? -uvw_m[0] : uvw_m[0], v_m = std::abs(uvw_m[1]);
  const double width = width_, height = height_;
  for (std::size_t c = 0; c < turns_per_m.size(); ++c) {
    const double u_turns = u_m * turns_per_m[c], v_turns = v_m * turns_per_m[c];
    const bool inside = inside_grid(u_turns, v_turns);
    const double u = inside ? u_turns * width : 0, v = inside ? v_turns * height : 0;
    const std::uint32_t column = static_cast<std::uint32_t>(floor_to_int(u) + origin_);
    const std::uint32_t at = number(static_cast<std::uint32_t>(static_cast<int>(v)), column);
    found[c] = inside ? at : outside;
  }
}

void UvCells::of_row(const double* uvw_m, const std::vector<double>& turns_per_m, std::uint32_t* cell) const {
  const auto count = static_cast<std::uint32_t>(columns());
  locate(
      uvw_m, turns_per_m, [count](std::uint32_t row, std::uint32_t column) { return row * count + column; }, cell);
}

void UvCells::places_of_row(const double* uvw_m, const std::vector<double>& turns_per_m, std::uint32_t* place_of) const {
  const std::uint32_t across = tiles_across();
  locate(
      uvw_m, turns_per_m, [across](std::uint32_t row, std::uint32_t column) { return place(row, column, across); }, place_of);
}

}  // namespace misfit::imager
