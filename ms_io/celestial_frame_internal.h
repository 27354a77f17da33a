#pragma once

#include <casacore/measures/Measures/MDirection.h>

#include <string>

#include "ms_io/celestial_frames.h"

namespace misfit::ms_io {

/// casacore's code of a frame of in_frame(). Throws std::invalid_argument for another.
casacore::MDirection::Types direction_type(const std::string& frame);

/// The frame that a code stands for; empty where in_frame() has no name for it.
std::string frame_name(casacore::MDirection::Types type);

/// The frame, as in_frame() calls it, of directions that have no right ascension and stand still against J2000; else empty.
std::string still_frame_name(casacore::MDirection::Types type);

/// 0 ≤ ra_rad < 2π. The frame is empty where frame_name() is.
imager::SkyDirection sky_direction(const casacore::MDirection& direction);

casacore::MDirection measure_of(const imager::SkyDirection& direction);

}  // namespace misfit::ms_io
