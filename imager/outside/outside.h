#pragma once

#include <vector>

#include "imager/clean/components.h"
#include "imager/source.h"
#include "imager/wide/wide_transform.h"

namespace misfit::imager {

/// A source outside an image, and what may show of it there through the kernel.
struct OutsideSource {
  Source source;
  double alias_jy = 0;  ///< the largest pixel of its alias, Jy/beam; its sidelobes, which no kernel removes, do not count
};

/// What is said of sources outside.
struct OutsideOptions {
  double least_jy = 0;      ///< fainter ones are not told from noise and sidelobes
  double max_sidelobe = 1;  ///< of the image's PSF; see alias_level
};

/// The components that CLEAN found in an image of a wider field, `found_in`, those within three pixels of a brighter one taken
/// together, which lie more than two of its pixels outside the image that `transform` makes; the one with the highest alias
/// first. Their places are known to half a pixel: the alias is the highest within that.
std::vector<OutsideSource> sources_outside(const std::vector<Component>& components, const ImageGeometry& found_in,
                                           const WideTransformOptions& transform, const OutsideOptions& options);

}  // namespace misfit::imager
