#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The response of the samples of a block to directions.
struct BlockResponse {
  std::size_t channels = 1;
  std::size_t groups = 1;            ///< of rows that respond alike
  std::vector<std::uint32_t> group;  ///< [row]
  std::vector<double> value;         ///< [direction][group][channel]

  double at(std::size_t direction, std::size_t sample) const {
    return value[(direction * groups + group[sample / channels]) * channels + sample % channels];
  }
};

/// The response of samples to directions, as in the definition of a mosaic: the beams of their dishes.
class SampleResponse {
 public:
  virtual ~SampleResponse() = default;
  virtual BlockResponse of(const SampleCoordinates& block, const std::vector<DirectionCosines>& directions) const = 0;
};

}  // namespace misfit::imager
