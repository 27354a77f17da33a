#include "tools/base/array.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>

BOOST_AUTO_TEST_SUITE(array)

namespace {

using namespace misfit;
using namespace misfit::tools;

constexpr double degree = M_PI / 180;

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return length(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

double longest_baseline_m(const AntennaArray& array) {
  double longest = 0;
  for (const auto& a : array.itrf_m)
    for (const auto& b : array.itrf_m) longest = std::max(longest, distance(a, b));
  return longest;
}

/// Antennas at Greenwich's meridian.
AntennaArray pair(const std::array<double, 3>& first, const std::array<double, 3>& second) {
  return {"PAIR", {"A", "B"}, {first, second}, 25};
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_vla_has_27_antennas_near_sea_level_and_is_smaller_than_the_last) {
  double last_m = 36500 * 3.285;
  for (const char* name : {"vla-a", "vla-b", "vla-c", "vla-d"}) {
    const AntennaArray vla = antenna_array(name);
    BOOST_TEST(vla.itrf_m.size() == 27u);
    BOOST_TEST(vla.name.size() == 27u);
    BOOST_TEST(vla.name[9] == "E1");
    const double longest_m = longest_baseline_m(vla);
    BOOST_TEST(std::abs(longest_m / last_m * 3.285 - 1) < 0.01);
    last_m = longest_m;
  }
}

BOOST_AUTO_TEST_CASE(stations_lie_where_the_arms_point_and_fall_with_the_curve_of_the_earth) {
  const AntennaArray vla = antenna_array("vla-a");
  const double c = std::cos(34.0787 * degree), s = std::sin(34.0787 * degree);
  const double cl = std::cos(-107.6184 * degree), sl = std::sin(-107.6184 * degree);
  const auto& end = vla.itrf_m[17];  // E9
  const double x = end[0] + 1601185.4, y = end[1] + 5041977.5, z = end[2] - 3554875.9;
  const double east = -sl * x + cl * y, out = cl * x + sl * y;
  const double north = c * z - s * out, up = c * out + s * z;
  BOOST_TEST(std::abs(std::atan2(east, north) / degree - 115) < 1e-6);
  BOOST_TEST(std::abs(std::hypot(east, north) - 21000) < 1e-6);
  BOOST_TEST(std::abs(up + 21000.0 * 21000 / 2 / 6371000) < 1e-6);
}

BOOST_AUTO_TEST_CASE(an_unknown_array_is_an_error_that_lists_the_names) {
  BOOST_CHECK_EXCEPTION(antenna_array("vla"), std::invalid_argument, [](const std::exception& error) {
    return std::string(error.what()).find("vla-a, vla-b, vla-c or vla-d") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(uvw_has_the_length_of_the_baseline) {
  const AntennaArray vla = antenna_array("vla-b");
  const std::vector<double> coordinates = uvw(vla, {0.7, -0.3});
  BOOST_REQUIRE(coordinates.size() == 27u * 26 / 2 * 3);
  const double* row = coordinates.data();
  for (std::size_t i = 0; i < 27; ++i)
    for (std::size_t j = i + 1; j < 27; ++j, row += 3)
      BOOST_TEST(std::abs(length(row[0], row[1], row[2]) / distance(vla.itrf_m[i], vla.itrf_m[j]) - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_north_south_baseline_has_no_u_at_transit) {
  const double dec_rad = 0.4;
  const auto coordinates = uvw(pair({6e6, 0, 2e6}, {5.9e6, 0, 2.3e6}), {0, dec_rad});
  BOOST_TEST(coordinates[0] == 0);
  BOOST_TEST(coordinates[1] > 0);  // the second antenna lies to the north
}

BOOST_AUTO_TEST_CASE(an_east_west_baseline_has_positive_u_at_transit_and_w_that_falls_with_time) {
  const AntennaArray east_west = pair({6e6, -50, 0}, {6e6, 50, 0});
  BOOST_TEST(std::abs(uvw(east_west, {0, 0.4})[0] - 100) < 1e-9);
  BOOST_TEST(std::abs(uvw(east_west, {0, 0.4})[2]) < 1e-9);
  // A source that has risen in the east is nearer to the eastern antenna.
  BOOST_TEST(uvw(east_west, {-0.3, 0.4})[2] > 0);
  BOOST_TEST(uvw(east_west, {0.3, 0.4})[2] < 0);
}

BOOST_AUTO_TEST_CASE(w_is_the_projection_on_the_source_and_u_its_derivative_along_hour_angle) {
  const AntennaArray two = pair({6e6, 100, 1e6}, {6e6 + 300, -100, 1e6 + 500});
  const double h = -0.8, dec = 0.6;
  const auto here = uvw(two, {h, dec});
  const double east_longitude = -h;  // of the place below the source, seen from the meridian
  const double w =
      300 * std::cos(dec) * std::cos(east_longitude) - 200 * std::cos(dec) * std::sin(east_longitude) + 500 * std::sin(dec);
  BOOST_TEST(std::abs(here[2] - w) < 1e-6);
  // ∂w/∂H = −u cos δ; ∂w/∂δ = v. Central differences: relative error step² plus rounding / step.
  const double step = 1e-5;
  const double by_hour_angle = (uvw(two, {h + step, dec})[2] - uvw(two, {h - step, dec})[2]) / (2 * step);
  const double by_declination = (uvw(two, {h, dec + step})[2] - uvw(two, {h, dec - step})[2]) / (2 * step);
  BOOST_TEST(std::abs(by_hour_angle + here[0] * std::cos(dec)) < 1e-4);
  BOOST_TEST(std::abs(by_declination - here[1]) < 1e-4);
}

BOOST_AUTO_TEST_CASE(sidereal_time_agrees_with_the_almanac) {
  // Meeus 1998, Astronomical Algorithms, examples 12.a and 12.b: 1987 April 10, 0h and 19h21m UT, to the digits printed.
  BOOST_TEST(std::abs(greenwich_mean_sidereal_time_rad(46895.0 * 86400) / degree * 240 - (13 * 3600 + 10 * 60 + 46.3668)) <
             1e-4);
  BOOST_TEST(std::abs(greenwich_mean_sidereal_time_rad(46895.80625 * 86400) / degree - 128.7378734) < 1e-6);
}

BOOST_AUTO_TEST_CASE(the_hour_angle_is_zero_at_transit_and_grows_by_a_turn_in_a_sidereal_day) {
  const AntennaArray vla = antenna_array("vla-a");
  for (const double ra_deg : {0.0, 60.0, 250.0, 359.0}) {
    const imager::SkyDirection source{ra_deg * degree, 0.7, "FK5"};
    const double near = 51544.5 * 86400 + 1000 * ra_deg, transit = transit_mjd_s(vla, source, near);
    // A time in MJD seconds has a step of 1e-6 s, 1e-10 rad.
    BOOST_TEST(std::abs(hour_angle_rad(vla, source, transit)) < 1e-9);
    BOOST_TEST(std::abs(transit - near) <= 43083);
    BOOST_TEST(std::abs(hour_angle_rad(vla, source, transit + 86164.0905 / 4) - M_PI_2) < 1e-8);
    BOOST_TEST(std::abs(hour_angle_rad(vla, source, transit - 86164.0905 / 4) + M_PI_2) < 1e-8);
  }
}

BOOST_AUTO_TEST_SUITE_END()
