#pragma once

#include <stdexcept>
#include <string>

#include "imager/data/visibilities.h"

namespace misfit::tools {

/// Returns action(); where that finds nothing usable in the MeasurementSet `vis`, the message names the set.
template <typename Action>
auto naming(const std::string& vis, const Action& action) {
  try {
    return action();
  } catch (const imager::NothingUsable& nothing) {
    throw std::runtime_error(vis + ": " + nothing.what());
  }
}

}  // namespace misfit::tools
