#include "imager/wide/stack_places.h"

#include <cmath>

#include "imager/numerics/constants.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time. The
// compiler vectorises these loops by itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/wide/stack_places.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

/// The place along an axis of the tile that holds the first tap.
struct TileAxis {
  double to_storage;
  double per_cell;

  TileAxis(const StackShape& s) : to_storage(1 - 0.5 * s.width + s.width / 2), per_cell(1.0 / s.tile) {}
  /// The whole part of cell / tile: half a cell is more than rounding takes off.
  HWY_INLINE std::int32_t tile(double cells) const {
    return static_cast<std::int32_t>((static_cast<std::int32_t>(cells + to_storage) + 0.5) * per_cell);
  }
};

HWY_ATTR void places(const StackRow& row, const StackShape& s, int width_w, const double* HWY_RESTRICT frequency_hz, int count,
                     const FirstTaps& out) {
  const double nu = s.nu, nv = s.nv, to_first = 0.5 - 0.5 * width_w;
  const std::int32_t tiles_u = s.tiles_u();
  const TileAxis axis(s);
  std::int32_t* HWY_RESTRICT const tile = out.tile;
  std::int32_t* HWY_RESTRICT const plane = out.plane;
  std::int32_t* HWY_RESTRICT const mirrored = out.mirrored;
  double* HWY_RESTRICT const period = out.period;
  for (int i = 0; i < count; ++i) {
    const double v = row.v_per_hz * frequency_hz[i], half = std::floor(2 * v / nv), odd = half - 2 * std::floor(0.5 * half);
    const double sign = 1 - 2 * odd, u = sign * (row.u_per_hz * frequency_hz[i]), period_u = std::floor(u / nu);
    const std::int32_t tile_u = axis.tile(u - nu * period_u), tile_v = axis.tile(sign * v - nv * std::floor(sign * v / nv));
    tile[i] = tile_u + tile_v * tiles_u;
    plane[i] = static_cast<std::int32_t>(std::floor(sign * (row.w_per_hz * frequency_hz[i]) + to_first));
    mirrored[i] = static_cast<std::int32_t>(odd);
    period[i] = period_u + 1e6 * half;
  }
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(places);

StackScale::StackScale(const StackShape& shape, const Facet& at, double plane_step)
    : u_cells_per_m_hz(-at.geometry.cell_rad * shape.nu / speed_of_light_m_s),
      v_cells_per_m_hz(at.geometry.cell_height_rad() * shape.nv / speed_of_light_m_s),
      planes_per_m_hz(1 / (plane_step * speed_of_light_m_s)),
      turns_per_m_hz(1 / speed_of_light_m_s),
      facet(at) {}

StackRow::StackRow(const double* uvw_m, bool mirrored, const StackScale& scale) {
  const double sign = mirrored ? -1 : 1;
  const double u = sign * uvw_m[0], v = sign * uvw_m[1], w = sign * uvw_m[2];
  const Facet& f = scale.facet;
  u_per_hz = (u + f.slope_l * w) * scale.u_cells_per_m_hz;
  v_per_hz = (v + f.slope_m * w) * scale.v_cells_per_m_hz;
  w_per_hz = w * scale.planes_per_m_hz;
  turns_per_hz = (u * f.geometry.centre.l + v * f.geometry.centre.m + w * f.middle) * scale.turns_per_m_hz;
}

void first_taps(const StackRow& row, const StackShape& shape, int width_w, const double* frequency_hz, int count,
                const FirstTaps& out) {
  HWY_DYNAMIC_DISPATCH(places)(row, shape, width_w, frequency_hz, count, out);
}

RowInTile row_in_tile(const StackRow& row, const StackShape& s, int tile_u, int tile_v, double frequency_hz) {
  const auto origin = [&](double per_hz, int tile, int length) {
    return tile * s.tile - s.margin() + 0.5 * s.width - 1 + length * std::floor(per_hz * frequency_hz / length);
  };
  return {row.u_per_hz, origin(row.u_per_hz, tile_u, s.nu), row.v_per_hz, origin(row.v_per_hz, tile_v, s.nv), s.tile};
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
