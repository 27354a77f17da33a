#include "tools/base/quantity.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

BOOST_AUTO_TEST_SUITE(quantity)

using namespace misfit::tools;

namespace {

constexpr double degree = M_PI / 180;

/// Equal up to the rounding of two or three products.
bool same(double a, double b) {
  return std::abs(a - b) <= 4e-16 * std::abs(b);
}

}  // namespace

BOOST_AUTO_TEST_CASE(angles_have_units_and_are_arcseconds_without) {
  BOOST_TEST(same(parse_angle_rad("180deg"), M_PI));
  BOOST_TEST(same(parse_angle_rad("1arcmin"), degree / 60));
  BOOST_TEST(same(parse_angle_rad("1arcsec"), degree / 3600));
  BOOST_TEST(same(parse_angle_rad("1"), degree / 3600));
  BOOST_TEST(same(parse_angle_rad("1000mas"), degree / 3600));
  BOOST_TEST(parse_angle_rad("0.25rad") == 0.25);
  BOOST_TEST(same(parse_angle_rad("20uas"), 20e-6 * degree / 3600));
  for (const char* mine : {"2uarcsec", "2uasec"}) BOOST_TEST(parse_angle_rad(mine) == parse_angle_rad("2uas"));
  for (const char* mine : {"2marcsec", "2masec"}) BOOST_TEST(parse_angle_rad(mine) == parse_angle_rad("2mas"));
  BOOST_TEST(parse_angle_rad("2asec") == parse_angle_rad("2arcsec"));
  BOOST_TEST(parse_angle_rad("2amin") == parse_angle_rad("2arcmin"));
  BOOST_TEST(same(parse_angle_rad("-1.5e-1 deg"), -0.15 * degree));
  BOOST_TEST(same(parse_angle_rad("+40deg"), 40 * degree));
  BOOST_TEST(parse_angle_rad("0") == 0);
}

BOOST_AUTO_TEST_CASE(flux_densities_are_jansky_without_a_unit) {
  BOOST_TEST(parse_flux_jy("2") == 2);
  BOOST_TEST(parse_flux_jy("2Jy") == 2);
  BOOST_TEST(same(parse_flux_jy("2mJy"), 2e-3));
  BOOST_TEST(same(parse_flux_jy(".5 uJy"), 5e-7));
}

BOOST_AUTO_TEST_CASE(frequencies_are_hertz_without_a_unit) {
  BOOST_TEST(parse_frequency_hz("1e9") == 1e9);
  BOOST_TEST(parse_frequency_hz("4GHz") == 4e9);
  BOOST_TEST(same(parse_frequency_hz("1420.405MHz"), 1.420405e9));
  BOOST_TEST(parse_frequency_hz("3kHz") == 3e3);
}

BOOST_AUTO_TEST_CASE(what_is_no_quantity_is_shown_with_what_was_expected) {
  for (const char* text : {"", " ", "arcsec", "1parsec", "1 Arcsec", "1,5arcsec", "1.5.2deg", "nan", "inf", "1e999deg", "--1",
                           "+-1", "++1", "0x10", "1arcsec2", "1mJy", "1 deg "}) {
    BOOST_CHECK_EXCEPTION(parse_angle_rad(text), std::invalid_argument, [&](const std::exception& error) {
      return std::string(error.what()) ==
             "'" + std::string(text) +
                 "' is no angle; expected a number with a unit of deg, arcmin, arcsec, mas, uas, rad, such as 0.2arcsec";
    });
  }
  BOOST_CHECK_THROW(parse_flux_jy("1Hz"), std::invalid_argument);
  BOOST_CHECK_THROW(parse_flux_jy("1jy"), std::invalid_argument);
  BOOST_CHECK_THROW(parse_frequency_hz("1Jy"), std::invalid_argument);
  BOOST_CHECK_THROW(parse_frequency_hz("1e305GHz"), std::invalid_argument);  // in Hz it is no number
}

BOOST_AUTO_TEST_SUITE_END()
