#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/numerics/big_array.h"
#include "imager/wide/stack_loops.h"

namespace misfit::imager {

/// The shape of half a grid, v ≥ 0. Cell (p, q) stands for u = −p/(nu · cell), v = q/(nv · cell), q ≤ nv/2, both taken modulo
/// the grid; a margin keeps the taps that leave it, and is folded in before the FFT.
struct StackShape {
  int nu = 0;     ///< length of the FFT along u
  int nv = 0;     ///< along v
  int width = 0;  ///< of the kernel, in cells
  int tile = 0;   ///< side of a tile, in cells; at least `width`

  int margin() const { return width / 2; }
  /// Cells along an axis that the taps of a tile may fall on.
  int reach() const { return tile + width - 1; }
  int tiles_u() const { return (nu + 2 * margin() + 1) / tile + 1; }
  int tiles_v() const { return (nv / 2 + 2 * margin() + 1) / tile + 1; }
  /// Rows of storage that taps may reach.
  int filled_rows() const { return (nv + 1) / 2 + 2 * margin() + 1; }
  /// Storage, margins included: room for a whole tile with the taps that leave it.
  int chunks() const { return tiles_u() + 1; }
  int columns() const { return chunks() * tile; }
  int rows() const { return (tiles_v() + 1) * tile; }
  /// Rows of storage held for a band of so many tiles: the rows that its taps reach, and the rows that wait for their mirror
  /// images.
  int held_rows(int tiles) const { return tiles * tile + 3 * width + 4; }
};

/// A tile's column and row among the tiles.
struct TilePlace {
  int u = 0;
  int v = 0;
};

/// A band of rows of half planes of constant w, each with one or more complex grids, plane i at the opposite w of plane
/// planes − 1 − i: the other half of a plane, v < 0, is the conjugate of the opposite plane's mirror image, G_i(−p, −q) = conj
/// G_{planes−1−i}(p, q). Cells of one row and one tile lie together: [row][chunk][plane][grid][column in chunk], a chunk being
/// as wide as a tile. Bands follow each other from the first row to the last in one piece of memory: as many rows of tiles as
/// caches hold, one at least.
template <typename Real>
class PlaneStack {
 public:
  PlaneStack(const StackShape& stack_shape, int grid_count) : shape(stack_shape), grids(grid_count) {}

  /// Makes room for that many planes and bands of so many tiles, from row 0 on; no row is used.
  void reserve(int plane_count, int band_tiles);
  /// Lets go of the rows before `first`, which is no less than any given before.
  void advance(int first, int threads);
  /// Sets cells to zero that taps of the tiles can reach and that were not used before.
  void use_tiles(const std::vector<TilePlace>& tiles, int threads);
  /// Marks a row as used; its content is undefined until somebody writes it.
  void use_row(int row);

  /// The cells of the tile at (tile_u, tile_v) from a plane on.
  StackCells<std::complex<Real>> cells_of(int tile_u, int tile_v, int plane, int plane_count) {
    return cells_at(chunk(tile_v * shape.tile, tile_u, plane, 0), plane_count);
  }
  StackCells<const std::complex<Real>> cells_of(int tile_u, int tile_v, int plane, int plane_count) const {
    return cells_at(chunk(tile_v * shape.tile, tile_u, plane, 0), plane_count);
  }

  int opposite(int plane) const { return planes - 1 - plane; }

  /// Calls visit(r) for the rows of storage whose mirror image is row q of the grid.
  template <typename Visit>
  void for_mirrored_rows(int q, const Visit& visit) const {
    for (const int other : {-q, shape.nv - q}) {
      const int row = other + shape.margin();
      if (row >= 0 && row < shape.filled_rows()) visit(row);
    }
  }
  /// True if row q of any grid may hold something.
  bool holds(int q) const;
  /// True if a chunk of a row of storage may hold something; the content of others is undefined.
  bool uses(int row, int index) const { return chunk_used_[chunk_number(row, index)] != 0; }

  std::complex<Real>* chunk(int row, int index, int plane, int grid) {
    return cell_.data() + offset(row - first_, index, plane, grid);
  }
  const std::complex<Real>* chunk(int row, int index, int plane, int grid) const {
    return cell_.data() + offset(row - first_, index, plane, grid);
  }

  StackShape shape;
  int planes = 0;
  int grids = 1;

 private:
  std::size_t chunk_number(int row, int index) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(shape.chunks()) + static_cast<std::size_t>(index);
  }
  template <typename Complex>
  StackCells<Complex> cells_at(Complex* first, int plane_count) const {
    const std::ptrdiff_t chunk_cells = shape.tile * planes * grids;
    return {first, grids * shape.tile, shape.chunks() * chunk_cells, shape.tile, plane_count, grids, shape.tile, chunk_cells};
  }
  std::size_t offset(int row, int index, int plane, int grid) const {
    const auto at = [](int i, int n) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(n); };
    return (at(row, shape.chunks()) + static_cast<std::size_t>(index)) * at(planes * grids, shape.tile) +
           at(plane * grids + grid, shape.tile);
  }

  BigArray<std::complex<Real>> cell_;
  std::vector<char> chunk_used_;  ///< [row][chunk], of all rows of storage, held or not
  int first_ = 0;                 ///< the first row that is held
  int held_ = 0;                  ///< how many rows are held
};

}  // namespace misfit::imager
