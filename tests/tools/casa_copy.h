#pragma once

#include <string>

namespace misfit::tools::testing {

/// Writes what a FITS image of two axes holds, pixels and coordinates, as a CASA image. Apart because casacore needs C++17.
void copy_to_casa(const std::string& fits, const std::string& path);

}  // namespace misfit::tools::testing
