#pragma once

#include <limits>

#include "imager/data/geometry.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// Gives `value` to the pixels beyond the horizon.
void set_beyond_horizon(const ImageGeometry& geometry, double value, Image& image);

/// The value of pixels beyond the horizon in images.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace misfit::imager
