#pragma once

#include <string>
#include <vector>

#include "imager/geometry.h"
#include "imager/image.h"
#include "imager/stokes.h"

namespace misfit::tools {

/// A mask for images of this geometry: 1 where CLEAN may take components from, 0 elsewhere. `path` is a FITS image of the same
/// size, whose pixels that are neither 0 nor NaN are allowed, or CASA region text (CRTF) of boxes, centred boxes and circles:
///
///     #CRTF
///     circle [[12h30m49.42s, +12d23m28.0s], 10arcsec]
///     box [[100pix, 100pix], [180pix, 140pix]]
///     -centerbox [[187.70deg, 12.39deg], [4arcsec, 2arcsec]]
///
/// Pixels count from 0, columns first. A minus sign takes a region's pixels away from those before it. `coord` must be the
/// image's frame; other keywords, and annotations, have no meaning here. Throws std::runtime_error that names the file, the
/// line and what was expected.
imager::Image read_mask(const std::string& path, const imager::ImageGeometry& geometry);

/// The same for images of these Stokes parameters: one mask for all, or one for each where the FITS image has a plane of each.
std::vector<imager::Image> read_masks(const std::string& path, const imager::ImageGeometry& geometry,
                                      const std::vector<imager::Stokes>& stokes);

}  // namespace misfit::tools
