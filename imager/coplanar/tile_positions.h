#pragma once

namespace misfit::imager {

/// Where samples lie in a tile's buffer: column and row of their first tap; t as in kernels::TapFunction.
template <typename Real>
struct TilePlaces {
  static constexpr int capacity = 128;
  int count = 0;
  int column[capacity];
  int row[capacity];
  Real tu[capacity];
  Real tv[capacity];
};

/// A row of samples as a tile sees it: at frequency f, u_per_hz · f − u_origin is the position along u of the sample's first
/// tap in [0, tile), whose whole part is the column and whose fraction is t + ½; likewise along v, with the row.
struct RowInTile {
  double u_per_hz = 0;
  double u_origin = 0;
  double v_per_hz = 0;
  double v_origin = 0;
  int tile = 0;
};

/// Appends to places, which must have room, the columns, rows, tu and tv of the samples at `count` frequencies. Positions
/// that rounding takes out of the tile are taken to the nearest cell within.
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<float>& places);
void append_positions(const RowInTile& row, const double* frequency_hz, int count, TilePlaces<double>& places);

/// Appends one sample, to the same bits, without vectors.
void append_position(const RowInTile& row, double frequency_hz, TilePlaces<float>& places);
void append_position(const RowInTile& row, double frequency_hz, TilePlaces<double>& places);

/// Rows of UVW at one frequency as a tile sees them, none beyond the grid: (u, v) in metres times *_cells_per_m are cells,
/// which are negated where v < 0.
struct RowsInTile {
  double u_cells_per_m_hz = 0;
  double v_cells_per_m_hz = 0;
  double frequency_hz = 0;
  double u_origin = 0;  ///< see RowInTile
  double v_origin = 0;
  int tile = 0;
};

/// Appends `count` rows of UVW [row][3]; `negated` [row] tells which were negated. The bits are those of rows one by one.
void append_rows(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<float>& places, bool* negated);
void append_rows(const RowsInTile& rows, const double* uvw_m, int count, TilePlaces<double>& places, bool* negated);

}  // namespace misfit::imager
