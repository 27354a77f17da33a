#pragma once

#include <string>

#include "imager/data/geometry.h"

namespace misfit::ms_io {

/// The direction in another frame: "ICRS", "FK5" (J2000), "FK4" (B1950, as it was in 1950) or "GALACTIC", whose ra_rad and
/// dec_rad are longitude and latitude; or one that images have not: "B1950_VLA" (B1950 as the VLA had it), "ECLIPTIC"
/// (of J2000) or "SUPERGAL". Throws std::invalid_argument where either frame is none of these.
imager::SkyDirection in_frame(const imager::SkyDirection& direction, const std::string& frame);

}  // namespace misfit::ms_io
