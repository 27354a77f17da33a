#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <vector>

#include "imager/coplanar/correction.h"
#include "imager/coplanar/half_grid.h"
#include "imager/coplanar/tap_table.h"
#include "imager/coplanar/tile_loops.h"
#include "imager/coplanar/tile_walk.h"
#include "imager/data/geometry.h"

namespace misfit::imager {

/// The data that adjoint and prediction share.
template <typename Real>
struct CoplanarSetup {
  ImageGeometry geometry;
  GridShape shape;
  TapTable<Real> taps_u;
  TapTable<Real> taps_v;
  ImageCorrection correction;
  int threads;
};

/// The four colours of tiles that hold samples; tiles of one colour may be flushed at the same time, since their buffers reach
/// into the next tile alone. Within a colour the fullest comes first, so that no thread starts the longest task last.
std::vector<std::vector<TileTask>> coloured_tasks(const TileOrder& order, const GridShape& shape);

/// The cell where a row of a tile begins in the grid.
inline std::size_t first_cell(const GridShape& shape, const TileTask& task, int row) {
  return static_cast<std::size_t>(task.tile_v * shape.tile + row) * static_cast<std::size_t>(shape.columns()) +
         static_cast<std::size_t>(task.tile_u * shape.tile);
}

/// Asks for a tile's part of a plane of the grid, so that it is at hand once its samples have been dealt with.
template <typename Real>
void prefetch_tile(const GridShape& shape, const TileTask& task, const Real* plane) {
  constexpr int line = 64 / sizeof(Real);
  const int reach = shape.tile + shape.width - 1;
  for (int r = 0; r < reach; ++r)
    for (int c = 0; c < reach + line - 1; c += line) hwy::Prefetch(plane + first_cell(shape, task, r) + std::min(c, reach - 1));
}

/// The cells of a tile in the planes of the grid.
template <typename Real>
TileCells<Real> cells_of(const GridShape& shape, const TileTask& task, const std::vector<Real*>& planes) {
  TileCells<Real> cells{static_cast<int>(planes.size()), {}, shape.columns()};
  for (std::size_t i = 0; i < planes.size(); ++i) cells.plane[i] = planes[i] + first_cell(shape, task, 0);
  return cells;
}

/// A tile of no more samples is gridded and degridded in place in the grid: a buffer costs more to bring and to add. Measured
/// for W = 4, 7 and 12: below 120 samples this holds in both directions, above 240 in neither.
inline constexpr std::size_t most_in_place = 192;
inline bool sparse(const TileOrder& order, const TileTask& task) {
  return order.samples[task.tile] <= most_in_place;
}

/// Sums in single precision stay short: a buffer is added to the grid after so many samples, sooner where the tile is crowded.
inline constexpr int most_in_tile_buffer = 2048;

}  // namespace misfit::imager
