#pragma once

#include <cmath>
#include <string>

namespace misfit::imager {

/// A sort of antennas, as a set describes them.
struct AntennaSort {
  std::string telescope;  ///< as in the set, such as "EVLA"
  double diameter_m = 0;  ///< as in the set; not positive where it does not say
  std::string name = {};  ///< of one of them, for messages
};

/// True where two antennas are of one sort, whatever their names.
inline bool alike(const AntennaSort& a, const AntennaSort& b) {
  const bool as_large = a.diameter_m == b.diameter_m || (std::isnan(a.diameter_m) && std::isnan(b.diameter_m));
  return as_large && a.telescope == b.telescope;
}

}  // namespace misfit::imager
