#include "tools/drawing/picture_script.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(picture_script)

using misfit::imager::Image;
using misfit::imager::SkyImage;
using misfit::testing::TemporaryFolder;

namespace {

constexpr double arcsec = M_PI / 180 / 3600;

SkyImage sky_image(int width, int height, double cell_rad) {
  SkyImage sky;
  sky.image = Image(width, height);
  sky.geometry = {width, height, cell_rad, {3.276, -0.2, "ICRS"}};
  return sky;
}

/// gnuplot's script for the picture of an image.
std::string script_of(const SkyImage& sky) {
  const TemporaryFolder folder;
  misfit::tools::write_picture_script({&sky, "one", ""}, folder / "");
  std::ostringstream text;
  text << std::ifstream(folder / "script").rdbuf();
  return text.str();
}

/// What follows `key` in a script, as a stream whose commas and colons are blanks.
std::istringstream after(const std::string& script, const std::string& key) {
  const std::size_t at = script.find(key);
  BOOST_TEST_REQUIRE(at != std::string::npos);
  std::string rest = script.substr(at + key.size());
  for (char& c : rest)
    if (c == ',' || c == ':') c = ' ';
  return std::istringstream(rest);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scale_bar_has_as_many_pixels_as_its_angle_has_cells) {
  for (const double cell_arcsec : {0.0003, 0.05, 1.7, 40.0}) {
    for (const auto& [width, height] : {std::pair{64, 64}, {1000, 700}, {900, 1001}}) {
      const std::string script = script_of(sky_image(width, height, cell_arcsec * arcsec));
      double from = 0, to = 0, south = 0, east = 0, west = 0, length = 0;
      std::string word, unit;
      after(script, "set arrow 1 from ") >> from >> south >> word >> to;
      after(script, "set xrange [") >> east >> west;
      after(script, "set label 6 '") >> length >> unit;
      const double pixels = (from - to) / (east - west) * width;
      const double size_arcsec = unit.starts_with("deg")      ? 3600
                                 : unit.starts_with("arcmin") ? 60
                                 : unit.starts_with("arcsec") ? 1
                                                              : 1e-3;
      // Eleven digits or more lie behind each of the numbers.
      BOOST_TEST(std::abs(pixels / (length * size_arcsec / cell_arcsec) - 1) < 1e-8);
      BOOST_TEST(to > west);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_beam_lies_in_the_lower_left_corner_with_its_tip_where_the_angle_says) {
  SkyImage sky = sky_image(200, 300, 0.1 * arcsec);
  sky.has_beam = true;
  for (const double angle : {-1.2, -0.4, 0.0, 0.7, 1.5}) {
    sky.beam = {3 * arcsec, 0.5 * arcsec, angle};
    std::istringstream polygon = after(script_of(sky), "set object 2 polygon from ");
    std::vector<std::pair<double, double>> corners(1);
    std::string to = "to";
    for (; to == "to" && polygon >> corners.back().first >> corners.back().second >> to;) corners.emplace_back();
    corners.pop_back();
    BOOST_TEST_REQUIRE(corners.size() > 8U);
    const auto [tip, other] = std::pair{corners.front(), corners[corners.size() / 2]};
    BOOST_TEST(std::abs(std::atan2(tip.first - other.first, tip.second - other.second) - angle) < 1e-8);
    BOOST_TEST(std::abs(std::hypot(tip.first - other.first, tip.second - other.second) - 3) < 1e-8);
    for (const auto& [east, north] : corners) {
      BOOST_TEST(east > 0);
      BOOST_TEST(east < 10);
      BOOST_TEST(north < 0);
      BOOST_TEST(north > -15);
    }
  }
}

BOOST_AUTO_TEST_CASE(without_a_beam_none_is_drawn) {
  BOOST_TEST(script_of(sky_image(100, 100, arcsec)).find("set object 2") == std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
