#include "imager/plane/tile_positions.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time. The
// compiler vectorises these loops by itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/plane/tile_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

struct Line {
  double per_hz;
  double origin;
  double tie;
};

template <typename Real>
HWY_ATTR HWY_INLINE void positions_along(Line line, int tile, const double* HWY_RESTRICT frequency_hz, int count,
                                         int* HWY_RESTRICT cell, Real* HWY_RESTRICT t) {
  for (int i = 0; i < count; ++i) {
    const double position = line.per_hz * frequency_hz[i] - line.origin;
    int whole = static_cast<int>(position + line.tie);
    whole = whole < 0 ? 0 : whole;
    whole = whole < tile ? whole : tile - 1;
    cell[i] = whole;
    t[i] = static_cast<Real>(position - whole - 0.5);
  }
}

template <typename Real>
HWY_ATTR void append(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<Real>& places) {
  const int at = places.count;
  positions_along({row.u_per_hz, row.u_origin, row.tie}, row.tile, frequency_hz, count, places.column + at, places.tu + at);
  positions_along({row.v_per_hz, row.v_origin, row.tie}, row.tile, frequency_hz, count, places.row + at, places.tv + at);
  places.count += count;
}

HWY_ATTR void append_float(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<float>& places) {
  append(row, frequency_hz, count, places);
}
HWY_ATTR void append_double(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<double>& places) {
  append(row, frequency_hz, count, places);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(append_float);
HWY_EXPORT(append_double);

void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<float>& places) {
  HWY_DYNAMIC_DISPATCH(append_float)(row, frequency_hz, count, places);
}
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<double>& places) {
  HWY_DYNAMIC_DISPATCH(append_double)(row, frequency_hz, count, places);
}

namespace {

struct PositionAlong {
  int cell;
  double t;

  PositionAlong(double position, double tie, int tile) : cell(static_cast<int>(position + tie)) {
    cell = cell < 0 ? 0 : cell;
    cell = cell < tile ? cell : tile - 1;
    t = position - cell - 0.5;
  }
};

template <typename Real>
void append_one(const RowInTile& row, double frequency_hz, TilePlaces<Real>& places) {
  const PositionAlong u(row.u_per_hz * frequency_hz - row.u_origin, row.tie, row.tile);
  const PositionAlong v(row.v_per_hz * frequency_hz - row.v_origin, row.tie, row.tile);
  const int at = places.count++;
  places.column[at] = u.cell;
  places.row[at] = v.cell;
  places.tu[at] = static_cast<Real>(u.t);
  places.tv[at] = static_cast<Real>(v.t);
}

}  // namespace

void append_position(const RowInTile& row, double frequency_hz, TilePlaces<float>& places) {
  append_one(row, frequency_hz, places);
}
void append_position(const RowInTile& row, double frequency_hz, TilePlaces<double>& places) {
  append_one(row, frequency_hz, places);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
