#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// The cells in which the density of samples is counted: those of the image's own uv grid, 1/(N cell) wavelengths wide, where N
/// is the image's width or height. A sample lies in column floor(u N cell) and row floor(v N cell), and its conjugate (−u, −v)
/// counts as another sample. So the plane is symmetric, and the half that v > 0 (or v = 0 and u ≥ 0) tells all of it: a sample
/// of the other half counts where its conjugate lies.
class UvCells {
 public:
  /// The cell of what lies beyond 1/(2 cell), or is not finite.
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

  /// What a metre is at each frequency, in turns per pixel. [channel]
  std::vector<double> turns_per_m(const std::vector<double>& frequency_hz) const;
  /// How far from u = v = 0 a sample lies where a metre is this many turns per pixel, in cells.
  double distance(const double* uvw_m, double turns_per_m) const {
    return turns_per_m * std::hypot(width_ * uvw_m[0], height_ * uvw_m[1]);
  }

  /// The cell, row-major [v][u], of a row's samples at each channel.
  void of_row(const double* uvw_m, const std::vector<double>& turns_per_m, std::uint32_t* cell) const;

 private:
  int width_;
  int height_;
  double cell_rad_;
  int origin_;  ///< the column that begins at u = 0
};

}  // namespace misfit::imager
