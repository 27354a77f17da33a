#pragma once

#include <string>

namespace misfit::imager {

/// Antennas as a set describes them.
struct AntennaSort {
  std::string telescope;  ///< as in the set, such as "EVLA"
  double diameter_m = 0;  ///< as in the set; not positive where it does not say
  std::string name = {};  ///< of one of them, for messages
};

}  // namespace misfit::imager
