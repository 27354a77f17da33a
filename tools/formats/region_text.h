#pragma once

#include <string>
#include <string_view>

#include "imager/geometry.h"
#include "imager/image.h"

namespace misfit::tools {

/// 1 in pixels that CASA region text (CRTF) of boxes, centred boxes and circles allows, 0 elsewhere:
///
///     #CRTF
///     circle [[12h30m49.42s, +12d23m28.0s], 10arcsec]
///     box [[100pix, 100pix], [180pix, 140pix]]
///     -centerbox [[187.70deg, 12.39deg], [4arcsec, 2arcsec]]
///
/// Pixels count from 0, columns first. A minus sign takes a region's pixels away from those before it. `coord` must be the
/// image's frame; other keywords, and annotations, have no meaning here. Throws std::runtime_error that names the file `path`,
/// the line and what was expected.
imager::Image regions_mask(const std::string& path, std::string_view text, const imager::ImageGeometry& geometry);

}  // namespace misfit::tools
