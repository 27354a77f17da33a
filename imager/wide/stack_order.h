#pragma once

#include <cstdint>
#include <vector>

#include "imager/data/visibilities.h"
#include "imager/wide/stack_places.h"

namespace misfit::imager {

/// Consecutive channels of one row, or of its mirror image, that fall into one tile and one period of the grid, and have one
/// first plane.
struct StackRun {
  std::uint32_t block;
  std::uint32_t row;
  std::int32_t plane;  ///< of the first tap
  std::uint32_t first : 20;
  std::uint32_t count : 11;
  std::uint32_t mirrored : 1;
};

/// Samples in the order in which tiles are visited: runs of tile i are run[begin[i]] … run[begin[i + 1] − 1], by plane and then
/// in the order of the blocks.
struct StackOrder {
  std::vector<std::size_t> begin;  ///< [tile + 1]
  std::vector<StackRun> run;
  std::vector<char> pair_used;  ///< [k]: whether any tap falls on plane k or on the opposite one, −1 − k
};

struct StackOrderOptions {
  StackShape shape;
  int width_w = 1;
  StackScale scale;
  int threads = 1;
};

/// Samples, of which those of weight 0 [row][channel] are not wanted; without weights all are wanted.
struct WantedSamples {
  const SampleCoordinates* at;
  const float* weight = nullptr;
};

/// Orders wanted samples, or their mirror images where v < 0, by the tile and the plane of their first tap.
StackOrder order_for_stack(const std::vector<WantedSamples>& blocks, const StackOrderOptions& options);

}  // namespace misfit::imager
