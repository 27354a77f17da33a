#pragma once

#include <string>

namespace misfit::imager {

/// The instruction set that the vector loops run with on this machine, as Highway calls it: "AVX2", "NEON".
std::string instruction_set();

/// Version of Highway, which the loops are compiled with: "1.0.3".
std::string highway_version();

}  // namespace misfit::imager
