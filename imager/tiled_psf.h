#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "imager/convolution.h"
#include "imager/image.h"

namespace misfit::imager {

/// Side of a tile of a residual, in pixels.
constexpr int residual_tile_side = 32;

/// A PSF as it is taken off residuals that lie in tiles: in single precision, with bounds of how strongly it reaches from tile
/// to tile. Made once, and used by any number of residuals and threads.
class TiledPsf {
 public:
  /// The peak of `psf` is its middle pixel. What is NaN counts as 0.
  TiledPsf(const Image& psf, int threads);

  int width() const { return width_; }
  int height() const { return height_; }
  int tiles_u() const { return tiles_u_; }  ///< of an image of this size
  int tiles_v() const { return tiles_v_; }

  const float* at(int row, int column) const { return &pixel_[index(row, column, columns_)]; }
  int columns() const { return columns_; }  ///< from a row of `at` to the next

  /// The largest |PSF| between any pixel of a tile and any of one that lies (rows, columns) of tiles beyond it; those of more
  /// columns follow. |rows| < tiles_v, |columns| < tiles_u.
  const float* reach(int rows, int columns) const {
    return &reach_[index(rows + tiles_v_ - 1, columns + tiles_u_ - 1, 2 * tiles_u_ - 1)];
  }
  /// With the PSF; made when it is first asked for.
  const Convolution<float>& convolution() const;

 private:
  static std::size_t index(int row, int column, int columns) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  void bound_reach();

  int width_;
  int height_;
  int threads_;
  int tiles_u_;
  int tiles_v_;
  int columns_;
  std::vector<float> pixel_;  ///< [row][column of columns_]
  std::vector<float> reach_;  ///< [rows + tiles_v − 1][columns + tiles_u − 1]
  mutable std::once_flag convolution_made_;
  mutable std::unique_ptr<Convolution<float>> convolution_;
};

}  // namespace misfit::imager
