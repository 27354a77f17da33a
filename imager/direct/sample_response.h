#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// By how much the samples of a block respond to directions.
struct BlockResponse {
  std::size_t channels = 1;
  std::size_t groups = 1;            ///< of rows that respond alike
  std::vector<std::uint32_t> group;  ///< [row]
  std::vector<double> value;         ///< [direction][group][channel]

  double at(std::size_t direction, std::size_t sample) const {
    return value[(direction * groups + group[sample / channels]) * channels + sample % channels];
  }
};

/// By how much samples respond to directions, as the definition of a mosaic has it: what dishes' beams let through.
class SampleResponse {
 public:
  virtual ~SampleResponse() = default;
  virtual BlockResponse of(const SampleCoordinates& block, const std::vector<DirectionCosines>& directions) const = 0;
};

}  // namespace misfit::imager
