#pragma once

#include <cstddef>
#include <vector>

#include "imager/clean/component_log.h"
#include "imager/clean/tiled_psf.h"
#include "imager/data/image.h"
#include "imager/data/noise.h"

namespace misfit::imager {

/// A residual from which components are taken one by one, and whose peak is asked for after each. It lies in tiles of blocks,
/// of which only those are looked at that could hold the peak: what may be left in a tile grows with every component by no more
/// than the largest value with which the PSF reaches it. In such a tile the blocks are bounded in the same way, and those that
/// could hold the peak are brought up to date. That is done for many blocks together where they have not been looked at for
/// long, and for all by a convolution as soon as the others have cost as much as one. So the cost of a component does not grow
/// with the PSF's area; the peaks are those of the plain loop in single precision, but for the rounding of sums of components
/// and of convolutions.
class TiledResidual {
 public:
  /// `psf` has the size of `residual`. What lies beyond it counts as 0. Both must outlive this.
  TiledResidual(const Image& residual, const TiledPsf& psf, int threads);

  /// The brightest pixel, the first in row-major order among equals; of value 0 where all pixels are NaN.
  Peak peak();
  /// Takes factor × PSF centred on a pixel off the residual.
  void subtract(int row, int column, float factor);

 private:
  /// The first pixel of a tile or block.
  struct Corner {
    int row;
    int column;
  };
  Corner tile_corner(std::size_t tile) const;
  Corner block_corner(std::size_t block) const;
  std::size_t block_at(int row, int column) const;
  float* pixels(std::size_t block);

  void load_row(int row, const float* from);
  void settle_all();
  void settle(std::size_t tile);
  void settle_row(std::size_t tile_row);
  std::vector<std::size_t> tiles_above(float bound) const;
  Peak first_peak(const std::vector<std::size_t>& tiles, float magnitude);

  bool refresh_tiles_at(float highest);
  void bound_blocks(std::size_t tile);
  std::size_t outstanding(std::size_t block) const;
  void refresh(std::size_t block);
  void refresh_together(float level);
  void refresh_all();

  const Image& residual_;
  const TiledPsf& psf_;
  int threads_;
  int tiles_u_;
  int tiles_v_;
  ComponentLog component_;
  std::size_t spent_ = 0;             ///< components times blocks off which they were taken since all were brought up to date
  std::vector<float> pixel_;          ///< [tile][block][row][column], NaN beyond the image
  std::vector<std::size_t> taken_;    ///< [tile][block]: components that have been taken off its pixels
  std::vector<float> block_bound_;    ///< [tile][block]: none of its pixels was brighter when its tile was bounded
  std::vector<std::size_t> bounded_;  ///< [tile]: components for which its blocks are bounded
  std::vector<float> tile_bound_;     ///< [tile]: none of its pixels is brighter
  std::vector<float> row_bound_;      ///< [row of tiles]: the largest bound
};

}  // namespace misfit::imager
