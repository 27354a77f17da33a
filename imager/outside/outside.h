#pragma once

#include <vector>

#include "imager/clean/components.h"
#include "imager/data/source.h"
#include "imager/outside/alias.h"

namespace misfit::imager {

/// A source outside an image, and the alias that the kernel may leave of it in the image.
struct OutsideSource {
  Source source;
  double alias_jy = 0;     ///< the largest pixel of its alias, Jy/beam; see AliasLevels
  bool at_border = false;  ///< at the border of the field where it was found: it may lie beyond, and be brighter
};

/// The sources among the components that CLEAN found in an image of a wider field, `found_in`: components close to a much
/// brighter one are taken together with it, and those count that lie more than half a pixel of `found_in` outside `image` and
/// have `least_jy` or more of either sign. The source with the highest alias comes first.
std::vector<OutsideSource> sources_outside(const std::vector<Component>& components, const ImageGeometry& found_in,
                                           const ImageGeometry& image, const AliasLevels& aliases, double least_jy);

}  // namespace misfit::imager
