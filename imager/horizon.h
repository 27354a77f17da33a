#pragma once

#include "imager/geometry.h"
#include "imager/image.h"

namespace misfit::imager {

/// Whether any pixel lies beyond the horizon, l² + m² > 1.
bool crosses_horizon(const ImageGeometry& geometry);

/// Makes the pixels beyond the horizon NaN.
void blank_beyond_horizon(const ImageGeometry& geometry, Image& image);

}  // namespace misfit::imager
