#pragma once

#include <vector>

#include "imager/tap_table.h"
#include "imager/tile_positions.h"

namespace misfit::imager {

/// Samples on their way to or from one tile.
template <typename Real>
struct TileBatch : TilePlaces<Real> {
  Real real[TilePlaces<Real>::capacity];
  Real imaginary[TilePlaces<Real>::capacity];
  Real weight[TilePlaces<Real>::capacity];
};

/// A tile's private piece of the grid, with room for the taps that leave the tile: [row][plane][column], planes real, imaginary
/// and (while gridding a PSF) weight.
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
};

/// Adds value · C_u · C_v of every sample to the buffer's planes. The kernels must have one width.
void spread(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& samples, TileBuffer<float>& buffer);
void spread(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& samples, TileBuffer<double>& buffer);

/// Sets every sample's value to Σ C_u · C_v · buffer: the transpose of spread.
void interpolate(const TapTable<float>& u, const TapTable<float>& v, const TileBuffer<float>& buffer,
                 TileBatch<float>& samples);
void interpolate(const TapTable<double>& u, const TapTable<double>& v, const TileBuffer<double>& buffer,
                 TileBatch<double>& samples);

}  // namespace misfit::imager
