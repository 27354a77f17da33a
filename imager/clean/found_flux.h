#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "imager/clean/bright_loops.h"

namespace misfit::imager {

/// Flux of components by squares of bright_tile_side pixels, since sidelobes of neighbours do not meet at random.
class FoundFlux {
 public:
  FoundFlux() = default;
  /// Begins without flux, in an image of this width and height.
  FoundFlux(int width, int height, std::size_t scales = 1)
      : across_((width + bright_tile_side - 1) / bright_tile_side), square_(scales), largest_(scales) {
    const int down = (height + bright_tile_side - 1) / bright_tile_side;
    in_square_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down) * scales);
  }

  void add(int row, int column, std::size_t scale, double jy) {
    const std::size_t at = static_cast<std::size_t>(row / bright_tile_side) * static_cast<std::size_t>(across_) +
                           static_cast<std::size_t>(column / bright_tile_side);
    double& flux = in_square_[at * square_.size() + scale];
    square_[scale] = std::max(0.0, square_[scale] + jy * (2 * flux + jy));
    flux += jy;
    largest_[scale] = std::max(largest_[scale], std::abs(flux));
  }
  double square(std::size_t scale) const { return square_[scale]; }    ///< Σ flux² of the squares
  double largest(std::size_t scale) const { return largest_[scale]; }  ///< |flux| of a square, now or before

 private:
  int across_ = 0;
  std::vector<double> in_square_;  ///< [row][column][scale]
  std::vector<double> square_;     ///< [scale]
  std::vector<double> largest_;
};

}  // namespace misfit::imager
