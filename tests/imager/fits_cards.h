#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace misfit::imager::testing {

/// All bytes of a file.
inline std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The card of a FITS file that begins with `keyword`, 80 characters; empty where it has none.
inline std::string card(const std::string& fits, const std::string& keyword) {
  for (std::size_t i = 0; i + 80 <= fits.size(); i += 80)
    if (fits.compare(i, 8, (keyword + "        ").substr(0, 8)) == 0) return fits.substr(i, 80);
  return "";
}

inline double number(const std::string& fits, const std::string& keyword) {
  return std::stod(card(fits, keyword).substr(9));
}

}  // namespace misfit::imager::testing
