#pragma once

#include <memory>
#include <utility>

#include "imager/direct/sample_response.h"
#include "imager/pointing/mosaic_beams.h"

namespace misfit::imager {

/// The beams of a mosaic, each at its channel's own frequency.
class MosaicResponse : public SampleResponse {
 public:
  explicit MosaicResponse(std::shared_ptr<const MosaicBeams> beams) : beams_(std::move(beams)) {}
  BlockResponse of(const SampleCoordinates& block, const std::vector<DirectionCosines>& directions) const override;

 private:
  std::shared_ptr<const MosaicBeams> beams_;
};

}  // namespace misfit::imager
