#pragma once

#include <cstddef>

#include "imager/coplanar/tile_positions.h"

namespace misfit::imager {

/// Images that are gridded together at most, each of which a sample has a share in.
inline constexpr std::size_t most_shared_images = 32;

/// Shares of the samples of a batch in several images. [image][sample]
struct BatchShares {
  static constexpr int capacity = TilePlaces<double>::capacity;
  double real[most_shared_images][capacity];
  double imaginary[most_shared_images][capacity];
};

/// By how much the samples of a block count in each of several images I_k that together make visibilities, V = Σ_k c_k A I_k.
class SampleShares {
 public:
  virtual ~SampleShares() = default;
  /// Writes c_k of `count` samples, each row × channels + channel.
  virtual void write(const std::size_t* sample, int count, BatchShares& to) const = 0;
};

}  // namespace misfit::imager
