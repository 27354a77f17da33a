#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "imager/clean/convolution.h"
#include "imager/data/image.h"
#include "imager/numerics/big_array.h"

namespace misfit::imager {

/// Sides of the squares in which a residual lies, in pixels: of a tile, and of the blocks that it is made of.
constexpr int residual_tile_side = 32;
constexpr int residual_block_side = 8;
constexpr int blocks_along_tile = residual_tile_side / residual_block_side;

/// How strongly a PSF reaches from one square of pixels to another, on a lattice of them.
class Reach {
 public:
  /// From the largest |PSF| in spans of `side` pixels, of which that from the middle pixel on is [rows][columns] in
  /// [2 rows][2 columns].
  Reach(int rows, int columns, const std::vector<float>& largest);

  /// No |PSF| between any pixel of a square and any of one that lies so many squares beyond it is larger; those of more columns
  /// follow. |rows| and |columns| are smaller than the lattice's.
  const float* operator()(int rows, int columns) const {
    return &value_[static_cast<std::size_t>(rows + rows_ - 1) * stride() + static_cast<std::size_t>(columns + columns_ - 1)];
  }
  std::size_t stride() const { return static_cast<std::size_t>(2 * columns_ - 1); }  ///< from a row to the next

 private:
  int rows_;
  int columns_;
  std::vector<float> value_;
};

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

  /// Row and column may lie a block's side beyond the PSF, where it is 0.
  const float* at(int row, int column) const {
    return pixel_.data() + static_cast<std::ptrdiff_t>(row + margin) * columns_ + column + margin;
  }
  int columns() const { return columns_; }  ///< from a row of `at` to the next

  const Reach& between_tiles() const { return *between_tiles_; }
  const Reach& between_blocks() const { return *between_blocks_; }
  /// With the PSF; made when it is first asked for.
  const Convolution<float>& convolution() const;

 private:
  static constexpr int margin = residual_block_side;

  std::vector<float> largest_in_blocks() const;

  int width_;
  int height_;
  int threads_;
  int tiles_u_;
  int tiles_v_;
  int columns_;
  BigArray<float> pixel_;  ///< [row + margin][column + margin of columns_]
  std::unique_ptr<Reach> between_tiles_;
  std::unique_ptr<Reach> between_blocks_;
  mutable std::once_flag convolution_made_;
  mutable std::unique_ptr<Convolution<float>> convolution_;
};

}  // namespace misfit::imager
