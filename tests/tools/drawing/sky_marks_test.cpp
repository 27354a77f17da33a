#include "tools/drawing/sky_marks.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(sky_marks)

using namespace misfit::tools;
using misfit::imager::Beam;

namespace {

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;

}  // namespace

BOOST_AUTO_TEST_CASE(the_tips_of_a_beam_lie_where_its_position_angle_says) {
  for (const double angle : {-80.0, -30.0, 0.0, 10.0, 45.0, 90.0}) {
    const Beam beam{6e-6, 1e-6, angle * degree};
    double longest = 0, shortest = 1;
    SkyOffset tip;
    for (const SkyOffset& at : beam_ellipse(beam)) {
      const double radius = std::hypot(at.east, at.north);
      if (radius > longest * (1 + 1e-9)) tip = at;
      longest = std::max(longest, radius);
      shortest = std::min(shortest, radius);
    }
    // From north, where east is 0, through east, where north is 0.
    BOOST_TEST(std::abs(std::atan2(tip.east, tip.north) - angle * degree) < 1e-9);
    BOOST_TEST(std::abs(longest - 3e-6) < 1e-15);
    BOOST_TEST(std::abs(shortest - 0.5e-6) < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(the_ellipse_touches_all_sides_of_its_box) {
  for (const double angle : {-65.0, 0.0, 20.0, 90.0}) {
    const Beam beam{6e-6, 1e-6, angle * degree};
    const SkyOffset reach = beam_reach(beam);
    double east = 0, north = 0;
    for (const SkyOffset& at : beam_ellipse(beam)) {
      east = std::max(east, at.east);
      north = std::max(north, at.north);
    }
    // A polygon of 72 corners falls short by no more than 1 - cos of half of its step, and that of the major axis.
    for (const double short_by : {reach.east - east, reach.north - north}) {
      BOOST_TEST(short_by >= -1e-18);
      BOOST_TEST(short_by <= 3e-6 * (1 - std::cos(M_PI / 72)));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_frame_ends_half_a_pixel_beyond_the_outermost_centres) {
  const SkyFrame frame = sky_frame({100, 51, 0.5 * arcsec, {}});
  BOOST_TEST(frame.unit.name == "arcsec");
  BOOST_TEST(std::abs(frame.east - 25.25) < 1e-12);
  BOOST_TEST(std::abs(frame.west + 24.75) < 1e-12);
  BOOST_TEST(std::abs(frame.south + 12.75) < 1e-12);
  BOOST_TEST(std::abs(frame.north - 12.75) < 1e-12);
}

BOOST_AUTO_TEST_CASE(a_scale_bar_is_as_long_as_its_label_says) {
  const std::pair<double, const char*> bars[] = {
      {0.23 * arcsec, "200 mas"}, {1.99 * arcsec, "1 arcsec"}, {14 * arcsec, "10 arcsec"},        {59 * arcsec, "30 arcsec"},
      {60 * arcsec, "1 arcmin"},  {250 * arcsec, "2 arcmin"},  {59.9 / 60 * degree, "30 arcmin"}, {degree, "1 deg"},
      {7 * degree, "5 deg"},      {30 * degree, "20 deg"},     {3.1e-6 * arcsec, "0.002 mas"}};
  for (const auto& [longest, label] : bars) {
    const ScaleBar bar = scale_bar(longest);
    BOOST_TEST(bar.label == label);
    const std::string unit = bar.label.substr(bar.label.find(' ') + 1);
    const double size = unit == "deg" ? degree : unit == "arcmin" ? degree / 60 : unit == "arcsec" ? arcsec : arcsec / 1000;
    BOOST_TEST(std::abs(std::stod(bar.label) * size / bar.length_rad - 1) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_scale_bar_takes_two_fifths_of_the_room_or_more) {
  for (double longest = 1e-12; longest < 2; longest *= 1.07) {
    const double part = scale_bar(longest).length_rad / longest;
    BOOST_TEST(part <= 1 + 1e-8);
    BOOST_TEST(part > 0.4 - 1e-8);
  }
}

BOOST_AUTO_TEST_SUITE_END()
