#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The part of an image that samples of one kind at one frequency make.
struct WeightShare {
  std::uint32_t kind = 0;
  double frequency_hz = 0;
  double weight = 0;  ///< Σ of their weights
};

/// The samples that count, and their kinds.
struct ShareOptions {
  double cell_rad = 0;                                      ///< samples beyond 1/(2 cell) take no part in the image
  std::function<std::uint32_t(std::uint64_t row)> kind_of;  ///< rows count through all blocks; empty: all are of kind 0
  int threads = 1;
};

/// The shares of all samples of `source`, as they are weighed there, in a pass over it; by kind, then by frequency. Where
/// several ranks share the samples, they are at rank 0.
std::vector<WeightShare> weight_shares(const VisibilitySource& source, const ShareOptions& options);

}  // namespace misfit::imager
