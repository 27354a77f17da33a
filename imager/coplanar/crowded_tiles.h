#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

#include "imager/coplanar/tile_loops.h"

namespace misfit::imager {

/// More samples of one tile than this are added up in double precision. Where terms are alike, a sum in single precision errs
/// to one side with every addition, by up to 2⁻²⁵ of itself: only few buffers of some thousand samples may be added up in it.
inline constexpr std::size_t most_in_single = std::size_t{1} << 15;
inline constexpr std::size_t one_by_one = 8;

/// The sums in double precision of those tiles of a single-precision grid that take very many samples. A buffer of one Stokes
/// parameter and the PSF is some 40 to 60 kB: up to 2 bytes for each of most_in_single samples, 16 where they are added one by
/// one, as from many small blocks. Each further Stokes parameter adds two thirds of that, and so does each image that samples
/// have shares in. A grid in double precision has no such sums.
template <typename Real>
class CrowdedTiles {
 public:
  /// Counts the samples that tiles take in, samples [tile], and gives tiles that are crowded from now on a buffer like
  /// `pattern`. Up to `most_alone` samples are added to the grid one by one, and count for more.
  void count(const std::vector<std::size_t>& samples, std::size_t most_alone, const TileBuffer<double>& pattern) {
    if constexpr (std::is_same_v<Real, float>) {
      taken_.resize(samples.size());
      sum_.resize(samples.size());
      for (std::size_t tile = 0; tile < samples.size(); ++tile) {
        taken_[tile] += (samples[tile] <= most_alone ? one_by_one : 1) * samples[tile];
        if (taken_[tile] > most_in_single && !sum_[tile]) sum_[tile] = std::make_unique<TileBuffer<double>>(pattern);
      }
    }
  }
  /// Null where the tile is not crowded.
  TileBuffer<double>* of(std::size_t tile) const { return tile < sum_.size() ? sum_[tile].get() : nullptr; }
  std::size_t tiles() const { return sum_.size(); }

 private:
  std::vector<std::size_t> taken_;
  std::vector<std::unique_ptr<TileBuffer<double>>> sum_;
};

}  // namespace misfit::imager
