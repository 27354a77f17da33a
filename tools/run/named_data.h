#pragma once

#include <stdexcept>
#include <string>

#include "imager/data/visibilities.h"

namespace misfit::tools {

/// What action() returns; where it finds nothing usable in the MeasurementSet `vis`, the message names that.
template <typename Action>
auto naming(const std::string& vis, const Action& action) {
  try {
    return action();
  } catch (const imager::NothingUsable& nothing) {
    throw std::runtime_error(vis + ": " + nothing.what());
  }
}

}  // namespace misfit::tools
