#pragma once

#include <cstddef>
#include <vector>

#include "imager/image.h"
#include "imager/noise.h"
#include "imager/tiled_psf.h"

namespace misfit::imager {

/// A residual from which components are taken one by one, and whose peak is asked for after each. It lies in tiles, of which
/// only those are looked at that could hold the peak: what may be left in a tile grows with every component by no more than the
/// largest value with which the PSF reaches it. Of such a tile the brightest pixels are brought up to date first, and the
/// others only when the same bound says that they could have become the brightest. Where many have to be, for many components,
/// all are by one convolution. So the cost of a component does not grow with the PSF's area; the peaks are those of the plain
/// loop in single precision, but for the rounding of convolutions.
class TiledResidual {
 public:
  /// `psf` has the size of `residual`. What lies beyond it counts as 0. Both must outlive this.
  TiledResidual(const Image& residual, const TiledPsf& psf, int threads);

  /// The brightest pixel, the first in row-major order among equals; of value 0 where all pixels are NaN.
  Peak peak();
  /// Takes factor × PSF centred on a pixel off the residual.
  void subtract(int row, int column, float factor);

 private:
  struct Component {
    int row;
    int column;
    float factor;
  };
  /// The brightest pixels of a tile, more up to date than the others.
  struct Bright {
    std::vector<int> place;   ///< in the tile, in its order
    std::vector<int> offset;  ///< of the same pixels in the PSF
    std::vector<float> value;
    std::size_t taken = 0;  ///< components that have been taken off them
    float peak = 0;         ///< the largest magnitude
  };

  void load(const Image& image);
  float* tile(std::size_t index);
  float row_bound(std::size_t tile_row) const;
  /// Whether the brightest pixel of a tile is known.
  bool certain(std::size_t index) const;
  bool refresh_tiles_at_peak();
  bool convolution_is_cheaper(float highest) const;
  void refresh_all();
  void refresh(std::size_t index);
  void refresh_bright(std::size_t index);
  void choose_bright(std::size_t index);

  const Image& residual_;
  const TiledPsf& psf_;
  int threads_;
  int tiles_u_;
  int tiles_v_;
  std::vector<Component> component_;
  std::vector<float> pixel_;        ///< [tile][row][column], NaN beyond the image
  std::vector<std::size_t> taken_;  ///< [tile]: components that have been taken off its pixels
  std::vector<Bright> bright_;      ///< [tile]
  std::vector<float> rest_bound_;   ///< [tile]: none of its other pixels is brighter; −∞ where there is none
  std::vector<float> bound_;        ///< [tile]: none of its pixels is brighter
  std::vector<float> row_bound_;    ///< [row of tiles]: the largest bound
};

}  // namespace misfit::imager
