#pragma once

#include <string>

namespace misfit::ms_io {

/// Version of the casacore that is linked: "3.5.0".
std::string casacore_version();

}  // namespace misfit::ms_io
