#pragma once

#include <casacore/measures/Measures/MDirection.h>

#include <string>

namespace misfit::ms_io {

/// casacore's code of a frame that SkyDirection names.
inline casacore::MDirection::Types direction_type(const std::string& frame) {
  return frame == "ICRS"  ? casacore::MDirection::ICRS
         : frame == "FK4" ? casacore::MDirection::B1950
                          : casacore::MDirection::J2000;
}

/// The frame that a code stands for; empty where SkyDirection has no name for it.
inline std::string frame_name(casacore::MDirection::Types type) {
  return type == casacore::MDirection::ICRS    ? "ICRS"
         : type == casacore::MDirection::B1950 ? "FK4"
         : type == casacore::MDirection::J2000 ? "FK5"
                                               : "";
}

}  // namespace misfit::ms_io
