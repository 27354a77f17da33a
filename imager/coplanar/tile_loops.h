#pragma once

#include <cstddef>
#include <vector>

#include "imager/coplanar/sample_shares.h"
#include "imager/coplanar/tap_table.h"
#include "imager/coplanar/tile_positions.h"
#include "imager/data/visibility_sets.h"

namespace misfit::imager {

/// The most samples of one cell that `spread` sums in registers: more in single precision would lose too much, since equal
/// terms err to one side.
inline constexpr int most_in_registers = 32;

/// Planes of a grid: real and imaginary parts of each image, and last (while gridding a PSF) weights.
inline constexpr int most_grid_planes = static_cast<int>(2 * most_shared_images) + 1;
static_assert(most_shared_images >= most_stokes);

/// Samples on their way to or from one tile.
template <typename Real>
struct TileBatch : TilePlaces<Real> {
  Real value[most_grid_planes][TilePlaces<Real>::capacity];  ///< [plane]
};

/// The cells of a tile in memory.
template <typename Real>
struct TileCells {
  int planes = 0;
  Real* plane[most_grid_planes] = {};  ///< row 0, column 0
  std::ptrdiff_t row = 0;              ///< from one row to the next

  operator TileCells<const Real>() const {
    TileCells<const Real> cells{planes, {}, row};
    for (int i = 0; i < planes; ++i) cells.plane[i] = plane[i];
    return cells;
  }
};

/// A tile's private piece of the grid, with room for the taps that leave the tile: [row][plane][column].
template <typename Real>
struct TileBuffer {
  int planes = 0;
  int rows = 0;
  int columns = 0;
  std::vector<Real> cell;

  TileBuffer(int tile, int padded_width, int plane_count)
      : planes(plane_count),
        rows(tile + padded_width),
        columns(tile + padded_width),
        cell(static_cast<std::size_t>(rows) * static_cast<std::size_t>(planes) * static_cast<std::size_t>(columns)) {}
  Real* row(int r, int plane) {
    return cell.data() + static_cast<std::size_t>(r * planes + plane) * static_cast<std::size_t>(columns);
  }
  TileCells<Real> cells() {
    TileCells<Real> cells{planes, {}, planes * columns};
    for (int plane = 0; plane < planes; ++plane) cells.plane[plane] = row(0, plane);
    return cells;
  }
};

/// Adds value · C_u · C_v of every sample to the planes. The kernels must have one width. Vectors reach beyond the last tap,
/// where they add 0.
void spread(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& samples, const TileCells<float>& cells);
void spread(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& samples,
            const TileCells<double>& cells);

/// Sets every sample's values of all pairs of planes to Σ C_u · C_v · cell: the transpose of spread.
void interpolate(const TapTable<float>& u, const TapTable<float>& v, const TileCells<const float>& cells,
                 TileBatch<float>& samples);
void interpolate(const TapTable<double>& u, const TapTable<double>& v, const TileCells<const double>& cells,
                 TileBatch<double>& samples);

}  // namespace misfit::imager
