#pragma once

#include <string>

#include "imager/data/visibilities.h"

namespace misfit::tools {

/// "12 of 1 000".
std::string left_out_of_all(const imager::SampleCounts& counts);

/// "10 flagged, 2 outside the grid", or "all can be imaged".
std::string left_out_reasons(const imager::SampleCounts& counts);

}  // namespace misfit::tools
