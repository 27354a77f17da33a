#pragma once

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

#include "imager/data/stokes.h"
#include "tools/formats/regions/region_text.h"

namespace misfit::tools::testing {

inline constexpr double degree = M_PI / 180, arcsec = degree / 3600;

/// An image of 61 × 47 pixels of 2″ whose phase centre, pixel (30, 23), is 187.7°, 12.39° in `frame`.
inline imager::ImageHeader header_in(const std::string& frame = "FK5", const std::string& stokes = "I", int channels = 1) {
  imager::ImageHeader header;
  header.geometry = {61, 47, 2 * arcsec, {187.7 * degree, 12.39 * degree, frame}};
  header.spectral = {1.42e9, 1e6, channels, "LSRK", 1.42e9};
  header.stokes = imager::parse_stokes(stokes);
  return header;
}

inline imager::Image mask_of(const std::string& text, const imager::ImageHeader& header = header_in()) {
  return RegionText("regions", text, header).mask({0, 0});
}

inline int count(const imager::Image& mask) {
  return static_cast<int>(std::count(mask.pixel.begin(), mask.pixel.end(), 1.0));
}

/// Two texts must give one mask, which holds some pixels and not all.
inline void check_same(const std::string& one, const std::string& other, const imager::ImageHeader& header = header_in()) {
  BOOST_TEST_CONTEXT(one << "  and  " << other) {
    const imager::Image a = mask_of(one, header), b = mask_of(other, header);
    BOOST_TEST(count(a) > 0);
    BOOST_TEST(count(a) < static_cast<int>(a.pixel.size()));
    BOOST_TEST((a.pixel == b.pixel));
  }
}

}  // namespace misfit::tools::testing
