#include "imager/coplanar/tile_positions.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time. The
// compiler vectorises these loops by itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/coplanar/tile_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

struct Line {
  double per_hz;
  double origin;
};

template <typename Real>
HWY_ATTR HWY_INLINE void positions_along(Line line, int tile, const double* HWY_RESTRICT frequency_hz, int count,
                                         int* HWY_RESTRICT cell, Real* HWY_RESTRICT t) {
  for (int i = 0; i < count; ++i) {
    const double position = line.per_hz * frequency_hz[i] - line.origin;
    int whole = static_cast<int>(position);
    whole = whole < 0 ? 0 : whole;
    whole = whole < tile ? whole : tile - 1;
    cell[i] = whole;
    t[i] = static_cast<Real>(position - whole - 0.5);
  }
}

template <typename Real>
HWY_ATTR void append(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<Real>& places) {
  const int at = places.count;
  positions_along({row.u_per_hz, row.u_origin}, row.tile, frequency_hz, count, places.column + at, places.tu + at);
  positions_along({row.v_per_hz, row.v_origin}, row.tile, frequency_hz, count, places.row + at, places.tv + at);
  places.count += count;
}

HWY_ATTR HWY_INLINE int cell_within(double position, int tile) {
  int whole = static_cast<int>(position);
  whole = whole < 0 ? 0 : whole;
  return whole < tile ? whole : tile - 1;
}

template <typename Real>
HWY_ATTR void append_some(RowsInTile rows, const double* HWY_RESTRICT uvw_m, int count, TilePlaces<Real>& places,
                          bool* HWY_RESTRICT negated) {
  int* HWY_RESTRICT const column = places.column + places.count;
  int* HWY_RESTRICT const row = places.row + places.count;
  Real* HWY_RESTRICT const tu = places.tu + places.count;
  Real* HWY_RESTRICT const tv = places.tv + places.count;
  for (int i = 0; i < count; ++i) {
    const double u_per_hz = uvw_m[3 * i] * rows.u_cells_per_m_hz, v_per_hz = uvw_m[3 * i + 1] * rows.v_cells_per_m_hz;
    const bool other_half = v_per_hz < 0;
    const double u = (other_half ? -u_per_hz : u_per_hz) * rows.frequency_hz - rows.u_origin;
    const double v = (other_half ? -v_per_hz : v_per_hz) * rows.frequency_hz - rows.v_origin;
    column[i] = cell_within(u, rows.tile);
    row[i] = cell_within(v, rows.tile);
    tu[i] = static_cast<Real>(u - column[i] - 0.5);
    tv[i] = static_cast<Real>(v - row[i] - 0.5);
    negated[i] = other_half;
  }
  places.count += count;
}

HWY_ATTR void append_rows_float(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<float>& places,
                                bool* negated) {
  append_some(rows, uvw_m, count, places, negated);
}
HWY_ATTR void append_rows_double(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<double>& places,
                                 bool* negated) {
  append_some(rows, uvw_m, count, places, negated);
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
HWY_EXPORT(append_rows_float);
HWY_EXPORT(append_rows_double);

void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<float>& places) {
  HWY_DYNAMIC_DISPATCH(append_float)(row, frequency_hz, count, places);
}
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<double>& places) {
  HWY_DYNAMIC_DISPATCH(append_double)(row, frequency_hz, count, places);
}

void append_rows(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<float>& places, bool* negated) {
  HWY_DYNAMIC_DISPATCH(append_rows_float)(rows, uvw_m, count, places, negated);
}
void append_rows(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<double>& places, bool* negated) {
  HWY_DYNAMIC_DISPATCH(append_rows_double)(rows, uvw_m, count, places, negated);
}

namespace {

struct PositionAlong {
  int cell;
  double t;

  PositionAlong(double position, int tile) : cell(static_cast<int>(position)) {
    cell = cell < 0 ? 0 : cell;
    cell = cell < tile ? cell : tile - 1;
    t = position - cell - 0.5;
  }
};

template <typename Real>
void append_one(const RowInTile& row, double frequency_hz, TilePlaces<Real>& places) {
  const PositionAlong u(row.u_per_hz * frequency_hz - row.u_origin, row.tile);
  const PositionAlong v(row.v_per_hz * frequency_hz - row.v_origin, row.tile);
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
