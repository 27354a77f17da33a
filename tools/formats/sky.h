#pragma once

#include <vector>

#include "imager/data/source.h"

namespace misfit::tools {

/// The 34 sources of Ye, Gull, Tan & Nikolic (2020, MNRAS 491, 1146) on cells of `cell_rad`.
std::vector<imager::Source> test_card(double cell_rad);

}  // namespace misfit::tools
