#pragma once

#include "imager/geometry.h"
#include "imager/image.h"

namespace misfit::imager {

/// Makes the pixels beyond the horizon NaN.
void blank_beyond_horizon(const ImageGeometry& geometry, Image& image);

}  // namespace misfit::imager
