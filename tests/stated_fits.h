#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "imager/data/image.h"

namespace misfit::testing {

/// Cards of a FITS header, keyword to value as it stands there: {"CTYPE1", "'RA---SIN'"}. An empty value stands for no card.
using StatedCards = std::map<std::string, std::string>;

/// The cards with others added, or in their place.
inline StatedCards with(StatedCards cards, const StatedCards& others) {
  for (const auto& [key, value] : others) cards[key] = value;
  return cards;
}

/// A card's value of a number, to all digits.
inline std::string stated(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17G", value);
  return text;
}

/// Writes a FITS image with 32-bit pixels and these cards, as whatever program may have made it: of two axes or, with
/// `planes` above 0, of three, each plane the same.
inline void write_stated_fits(const std::string& path, const imager::Image& image, const StatedCards& cards, int planes = 0) {
  std::string fits;
  const auto add = [&fits](const std::string& keyword, const std::string& value) {
    fits += ((keyword + "        ").substr(0, 8) + "= " + value + std::string(80, ' ')).substr(0, 80);
  };
  add("SIMPLE", "                   T");
  add("BITPIX", "-32");
  add("NAXIS", planes > 0 ? "3" : "2");
  add("NAXIS1", std::to_string(image.width));
  add("NAXIS2", std::to_string(image.height));
  if (planes > 0) add("NAXIS3", std::to_string(planes));
  for (const auto& [keyword, value] : cards)
    if (!value.empty()) add(keyword, value);
  fits += "END" + std::string(77, ' ');
  const auto fill = [&fits](char with) { fits.resize((fits.size() + 2879) / 2880 * 2880, with); };
  fill(' ');
  for (int plane = 0; plane < std::max(planes, 1); ++plane)
    for (const double pixel : image.pixel) {
      const auto value = static_cast<float>(pixel);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      for (const int shift : {24, 16, 8, 0}) fits += static_cast<char>(bits >> shift & 0xff);
    }
  fill('\0');
  std::ofstream(path, std::ios::binary) << fits;
}

}  // namespace misfit::testing
