#pragma once

#include <string>
#include <vector>

namespace misfit::imager {

/// One thing that was decided for a run, and the number that decided it.
struct Decision {
  std::string item;      ///< what was decided: "kernel width"
  std::string decision;  ///< how: "7"
  std::string because;   ///< why, with the number
};

using Plan = std::vector<Decision>;

}  // namespace misfit::imager
