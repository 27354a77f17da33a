#pragma once

#include "imager/tile_loops.h"

namespace misfit::imager {

/// A row of samples as a tile sees it: at frequency f, u_per_hz · f − u_origin is the position along u of the sample's first
/// tap in [0, tile), whose whole part is the column and whose fraction is t + ½; so along v, with the row.
struct RowInTile {
  double u_per_hz = 0;
  double u_origin = 0;
  double v_per_hz = 0;
  double v_origin = 0;
  int tile = 0;
};

/// Appends to the batch, which must have room, the columns, rows, tu and tv of the samples at `count` frequencies. Positions
/// that rounding takes out of the tile are taken to the nearest cell within.
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TileBatch<float>& batch);
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TileBatch<double>& batch);

}  // namespace misfit::imager
