#pragma once

#include <sstream>
#include <string>

namespace misfit::kernels {

/// A number as messages and names show it: 0.5, not 0.500000.
inline std::string text_of(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace misfit::kernels
