#include "imager/data/visibility_sets.h"

#include <stdexcept>
#include <string>

namespace misfit::imager {

VisibilitySets::VisibilitySets(const VisibilityBlock& block, int images) {
  if (images != 1 && block.stokes() != static_cast<std::size_t>(images))
    throw std::invalid_argument("a block of " + std::to_string(block.stokes()) + " Stokes parameters for " +
                                std::to_string(images) + " images; expected one for each");
  if (block.visibility.size() != block.stokes() * block.samples())
    throw std::invalid_argument(std::to_string(block.visibility.size()) + " visibilities of " +
                                std::to_string(block.samples()) + " samples; expected as many for each Stokes parameter");
  for (int i = 0; i < images; ++i) emplace_back(block.visibility_of(static_cast<std::size_t>(i)));
}

VisibilitySets::VisibilitySets(const std::vector<std::vector<std::complex<double>>>& several) {
  for (const auto& one : several) emplace_back(one.data());
}

}  // namespace misfit::imager
