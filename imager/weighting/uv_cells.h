#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// The cells in which the density of samples is counted: those of the image's own uv grid, 1/(N cell) wavelengths wide, where N
/// is the image's width or height. A sample lies in column floor(u N cell) and row floor(v N cell), and its conjugate (−u, −v)
/// counts as another sample. So the plane is symmetric, and the half with v > 0 (or v = 0 and u ≥ 0) tells all of it: a sample
/// of the other half counts where its conjugate lies.
class UvCells {
 public:
  /// The cell of samples beyond 1/(2 cell), or not finite.
  static constexpr std::uint32_t outside = std::numeric_limits<std::uint32_t>::max();

  explicit UvCells(const ImageGeometry& geometry);

  int columns() const { return width_ + 1; }  ///< from u = −1/(2 cell), which may lie within the first
  int rows() const { return height_ / 2 + 1; }
  std::size_t count() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  /// The column that holds the conjugates of `column`'s samples; it may lie beyond the last.
  int conjugate_column(int column) const { return 2 * origin_ - 1 - column; }
  /// Width of a column in wavelengths.
  double width_lambda() const { return 1 / (width_ * cell_rad_); }
  double height_lambda() const { return 1 / (height_ * cell_rad_); }

  /// A metre at each frequency, in turns per pixel. [channel]
  std::vector<double> turns_per_m(const std::vector<double>& frequency_hz) const;
  /// The distance of a sample from u = v = 0, in cells, where a metre is this many turns per pixel.
  double distance(const double* uvw_m, double turns_per_m) const {
    return turns_per_m * std::hypot(width_ * uvw_m[0], height_ * uvw_m[1]);
  }

  /// The cell, row-major [v][u], of a row's samples at each channel.
  void of_row(const double* uvw_m, const std::vector<double>& turns_per_m, std::uint32_t* cell) const;

  /// Tiles are squares of cells: near cells have places that lie together. Tiles at the end of a row or column of tiles may
  /// reach beyond the cells.
  static constexpr std::uint32_t tile_side = 8;
  static constexpr std::uint32_t tile_cells = tile_side * tile_side;
  std::uint32_t tiles_across() const { return (static_cast<std::uint32_t>(columns()) + tile_side - 1) / tile_side; }
  std::size_t tiles() const {
    return std::size_t{tiles_across()} * ((static_cast<std::uint32_t>(rows()) + tile_side - 1) / tile_side);
  }
  /// The place of a cell where cells are counted tile by tile; cells in a tile, and tiles, are row-major [v][u].
  std::uint32_t place(int row, int column) const {
    return place(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column), tiles_across());
  }
  /// The places of a row's samples at each channel, or `outside`.
  void places_of_row(const double* uvw_m, const std::vector<double>& turns_per_m, std::uint32_t* place) const;

 private:
  static std::uint32_t place(std::uint32_t row, std::uint32_t column, std::uint32_t tiles_across) {
    const std::uint32_t tile = row / tile_side * tiles_across + column / tile_side;
    return tile * tile_cells + row % tile_side * tile_side + column % tile_side;
  }
  /// Sets number(row, column) of a row's samples at each channel.
  template <typename Number>
  void locate(const double* uvw_m, const std::vector<double>& turns_per_m, const Number& number, std::uint32_t* found) const;

  int width_;
  int height_;
  double cell_rad_;
  int origin_;  ///< the column that begins at u = 0
};

}  // namespace misfit::imager
