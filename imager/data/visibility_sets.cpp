#include "imager/data/visibility_sets.h"

#include <string>

namespace misfit::imager {

std::vector<VisibilitySet> sets_of(const VisibilityBlock& block, int images) {
  std::vector<VisibilitySet> sets{block.visibility.data()};
  if (images == 1) return sets;
  const std::size_t carried = 1 + block.other_stokes.size();
  if (carried != static_cast<std::size_t>(images))
    throw std::invalid_argument("a block of " + std::to_string(carried) + " Stokes parameters for " + std::to_string(images) +
                                " images; expected one for each");
  for (const auto& other : block.other_stokes) {
    if (other->visibility.size() != block.samples())
      throw std::invalid_argument(std::to_string(other->visibility.size()) + " visibilities of another Stokes parameter for " +
                                  std::to_string(block.samples()) + " samples; expected as many");
    sets.emplace_back(other->visibility.data());
  }
  return sets;
}

}  // namespace misfit::imager
