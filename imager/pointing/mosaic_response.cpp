#include "imager/pointing/mosaic_response.h"

namespace misfit::imager {

BlockResponse MosaicResponse::of(const SampleCoordinates& block, const std::vector<DirectionCosines>& directions) const {
  const std::vector<RowBeams::Group> groups = beams_->rows().groups(block);
  BlockResponse response{block.channels(), groups.size(), std::vector<std::uint32_t>(block.rows()), {}};
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::size_t row : groups[g].rows) response.group[row] = static_cast<std::uint32_t>(g);
  for (const DirectionCosines at : directions)
    for (const RowBeams::Group& group : groups)
      for (const double hz : block.frequency_hz) response.value.push_back(beams_->power(group.beam, at, hz));
  return response;
}

}  // namespace misfit::imager
