#include "imager/wide/stack_places.h"

#include <algorithm>
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

struct Axis {
  double cells_per_hz;
  int length;
  int width;
  int tile;
  double tie;
};

/// The tile of the first tap, and the period.
HWY_ATTR HWY_INLINE void tiles_along(Axis axis, const double* HWY_RESTRICT frequency_hz, int count,
                                     std::int32_t* HWY_RESTRICT tile, double* HWY_RESTRICT period) {
  const double n = axis.length, to_storage = 1 - 0.5 * axis.width + axis.width / 2;
  for (int i = 0; i < count; ++i) {
    const double cells = axis.cells_per_hz * frequency_hz[i] + axis.tie;
    period[i] = std::floor(cells / n);
    tile[i] = static_cast<std::int32_t>(cells - n * period[i] + to_storage) / axis.tile;
  }
}

HWY_ATTR void places(const StackRow& row, const StackShape& s, int width_w, const double* HWY_RESTRICT frequency_hz, int count,
                     const FirstTaps& out) {
  constexpr int at_once = 128;
  std::int32_t tile_v[at_once];
  double period_v[at_once];
  const double sign = row.mirrored ? -1 : 1, to_first = 0.5 - 0.5 * width_w;
  const int last = row.mirrored ? -width_w : 0;
  for (int begin = 0; begin < count; begin += at_once) {
    const int some = std::min(at_once, count - begin);
    const double* HWY_RESTRICT frequency = frequency_hz + begin;
    std::int32_t* HWY_RESTRICT tile = out.tile + begin;
    std::int32_t* HWY_RESTRICT plane = out.plane + begin;
    double* HWY_RESTRICT period = out.period + begin;
    tiles_along({row.u_per_hz, s.nu, s.width, s.tile, row.tie()}, frequency, some, tile, period);
    tiles_along({row.v_per_hz, s.nv, s.width, s.tile, row.tie()}, frequency, some, tile_v, period_v);
    for (int i = 0; i < some; ++i) {
      tile[i] += tile_v[i] * s.tiles_u();
      period[i] += 1e6 * period_v[i];
      const double first = std::floor(sign * row.w_per_hz * frequency[i] + to_first);
      plane[i] = last + static_cast<std::int32_t>(sign * first);
    }
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

StackRow::StackRow(const double* uvw_m, bool mirror, const StackScale& scale) : mirrored(mirror) {
  const double sign = mirror ? -1 : 1;
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
    return tile * s.tile - s.margin() + 0.5 * s.width - 1 + length * std::floor((per_hz * frequency_hz + row.tie()) / length);
  };
  return {row.u_per_hz, origin(row.u_per_hz, tile_u, s.nu), row.v_per_hz, origin(row.v_per_hz, tile_v, s.nv), s.tile,
          row.tie()};
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
