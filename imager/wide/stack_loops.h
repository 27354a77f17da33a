#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/coplanar/tap_table.h"
#include "imager/coplanar/tile_positions.h"
#include "imager/data/visibility_sets.h"

namespace misfit::imager {

/// Grids of a plane: of images, and last, while gridding one, of the PSF.
inline constexpr int most_grids = most_stokes + 1;

/// Samples on their way to or from one tile of a stack of planes. `plane` is the place of the first tap in the tile's buffer;
/// it may lie below or above the planes there: taps outside do not count.
template <typename Real>
struct StackBatch : TilePlaces<Real> {
  int plane[TilePlaces<Real>::capacity];
  Real tw[TilePlaces<Real>::capacity];
  std::complex<Real> value[most_grids][TilePlaces<Real>::capacity];  ///< [grid]
};

/// The cells of a tile in memory. Distances are in cells.
template <typename Complex>
struct StackCells {
  Complex* first = nullptr;  ///< plane 0, row 0, grid 0, column 0
  std::ptrdiff_t plane = 0;  ///< from one plane to the next
  std::ptrdiff_t row = 0;
  std::ptrdiff_t grid = 0;
  int planes = 0;
  int grids = 0;
  int columns = 0;          ///< that lie together; taps may reach into the next as many
  std::ptrdiff_t next = 0;  ///< from one group of columns to the next

  operator StackCells<const Complex>() const { return {first, plane, row, grid, planes, grids, columns, next}; }
};

/// A tile's private piece of a stack of one or more grids a plane, with room for the taps that leave the tile:
/// [plane][row][grid][column]. All of it is zero, except values that a user has put there and not yet moved on.
template <typename Real>
struct StackBuffer {
  int planes = 0;
  int grids = 0;
  int rows = 0;
  int columns = 0;
  std::vector<std::complex<Real>> cell;

  StackBuffer(int tile, int width, int grid_count)
      : grids(grid_count), rows(tile + width), columns(tile + most_columns(width)) {}

  /// Makes room for that many planes.
  void reserve(int plane_count) {
    planes = plane_count;
    if (cell.size() < offset(planes, 0, 0)) cell.resize(offset(planes, 0, 0));
  }
  StackCells<std::complex<Real>> cells() {
    return {cell.data(), rows * grids * columns, grids * columns, columns, planes, grids, columns, 0};
  }
  std::complex<Real>* row(int plane, int r, int grid) { return cell.data() + offset(plane, r, grid); }
  const std::complex<Real>* row(int plane, int r, int grid) const { return cell.data() + offset(plane, r, grid); }

 private:
  /// The most columns that the taps of a row fill: whole vectors of 64 bytes.
  static int most_columns(int width) {
    constexpr int vector = 64 / sizeof(std::complex<Real>);
    return (width + vector - 1) / vector * vector;
  }
  std::size_t offset(int plane, int r, int grid) const {
    return static_cast<std::size_t>((plane * rows + r) * grids + grid) * static_cast<std::size_t>(columns);
  }
};

/// Kernels along the three axes; those along u and v have one width.
template <typename Real>
struct StackTaps {
  TapTable<Real> u;
  TapTable<Real> v;
  TapTable<Real> w;
};

/// Adds value · C_u · C_v · C_w of every sample to every grid. Vectors reach beyond the last tap, where they add 0.
void spread(const StackTaps<float>& taps, const StackBatch<float>& samples, const StackCells<std::complex<float>>& cells);
void spread(const StackTaps<double>& taps, const StackBatch<double>& samples, const StackCells<std::complex<double>>& cells);

/// Sets every sample's first value to Σ C_u · C_v · C_w · cell: the transpose of spread for one grid.
void interpolate(const StackTaps<float>& taps, const StackCells<const std::complex<float>>& cells, StackBatch<float>& samples);
void interpolate(const StackTaps<double>& taps, const StackCells<const std::complex<double>>& cells,
                 StackBatch<double>& samples);

/// to[i] += from[i], from[i] = 0.
void move_cells(std::complex<float>* from, int count, std::complex<float>* to);
void move_cells(std::complex<double>* from, int count, std::complex<double>* to);

}  // namespace misfit::imager
