#pragma once

#include <vector>

#include "imager/clean/components.h"
#include "imager/data/source.h"
#include "imager/outside/alias.h"

namespace misfit::imager {

/// A source outside an image, and what may show of it there through the kernel.
struct OutsideSource {
  Source source;
  double alias_jy = 0;     ///< the largest pixel of what gridding makes of it, Jy/beam; see AliasLevels
  bool at_border = false;  ///< of the field that it was found in: it may lie beyond, and be brighter
};

/// The components that CLEAN found in an image of a wider field, `found_in`, those close to a much brighter one taken together
/// with it, which lie more than half of its pixels outside `image` and have `least_jy` or more of either sign.
/// The one with the highest alias comes first.
std::vector<OutsideSource> sources_outside(const std::vector<Component>& components, const ImageGeometry& found_in,
                                           const ImageGeometry& image, const AliasLevels& aliases, double least_jy);

}  // namespace misfit::imager
