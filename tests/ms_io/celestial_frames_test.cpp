#include "ms_io/celestial_frames.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

BOOST_AUTO_TEST_SUITE(celestial_frames)

using misfit::imager::SkyDirection;
using misfit::ms_io::in_frame;

namespace {

constexpr double degree = M_PI / 180, arcsec = degree / 3600;

double distance_rad(const SkyDirection& a, const SkyDirection& b) {
  BOOST_TEST(a.frame == b.frame);
  const double east = std::remainder(a.ra_rad - b.ra_rad, 2 * M_PI) * std::cos(b.dec_rad);
  return std::hypot(east, a.dec_rad - b.dec_rad);
}

}  // namespace

BOOST_AUTO_TEST_CASE(there_and_back_is_the_same_direction) {
  for (const double ra : {0.0, 1.2, 3.1, 4.6, 6.2})
    for (const double dec : {-1.5, -0.3, 0.0, 0.8, 1.5})
      for (const char* from : {"ICRS", "FK5", "FK4", "GALACTIC"})
        for (const char* to : {"ICRS", "FK5", "FK4", "GALACTIC", "B1950_VLA", "ECLIPTIC", "SUPERGAL"}) {
          const SkyDirection here{ra, dec, from}, there = in_frame(here, to);
          BOOST_TEST(there.ra_rad >= 0);
          BOOST_TEST(there.ra_rad < 2 * M_PI);
          // casacore's way to and from FK4 undoes the E-terms of aberration to second order.
          const auto exact = [](const std::string& frame) { return frame == "ICRS" || frame == "FK5" || frame == "GALACTIC"; };
          BOOST_TEST(distance_rad(in_frame(there, from), here) < (exact(from) && exact(to) ? 1e-13 : 1e-9));
        }
}

BOOST_AUTO_TEST_CASE(every_way_between_frames_leads_to_the_same_direction) {
  const std::vector<std::string> frames{"ICRS", "FK5", "GALACTIC", "SUPERGAL", "ECLIPTIC"};
  for (const double ra : {0.4, 2.9, 5.8})
    for (const double dec : {-1.2, 0.1, 1.4})
      for (const std::string& from : frames)
        for (const std::string& over : frames)
          for (const std::string& to : frames)
            // Each conversion rounds by a few parts in 1e16.
            BOOST_TEST(distance_rad(in_frame(in_frame({ra, dec, from}, over), to), in_frame({ra, dec, from}, to)) < 1e-14);
}

BOOST_AUTO_TEST_CASE(galactic_coordinates_are_those_of_other_software) {
  // Astropy 5.2. Between FK5 and ICRS it has the rotation of the Hipparcos Catalogue (ESA 1997, vol. 1, section 1.5.7),
  // casacore that of the dynamical J2000, 0.03 arcsec away.
  const std::vector<std::pair<SkyDirection, SkyDirection>> values{
      {{120 * degree, 30 * degree, "GALACTIC"}, {234.0494914955 * degree, 86.1432027909 * degree, "FK5"}},
      {{120 * degree, 30 * degree, "GALACTIC"}, {234.0495636261 * degree, 86.1431998000 * degree, "ICRS"}},
      {{120 * degree, 30 * degree, "SUPERGAL"}, {223.5948175843 * degree, 4.8046712903 * degree, "FK5"}},
      {{120 * degree, 30 * degree, "SUPERGAL"}, {223.5948117062 * degree, 4.8046693093 * degree, "ICRS"}},
      {{0.5 * degree, 0 * degree, "GALACTIC"}, {266.7014572679 * degree, -28.5090784423 * degree, "FK5"}},
      {{0.5 * degree, 0 * degree, "GALACTIC"}, {266.7014493633 * degree, -28.5090838155 * degree, "ICRS"}},
      {{0.5 * degree, 0 * degree, "SUPERGAL"}, {42.8432284507 * degree, 59.9500478167 * degree, "FK5"}},
      {{0.5 * degree, 0 * degree, "SUPERGAL"}, {42.8432121124 * degree, 59.9500497221 * degree, "ICRS"}},
      {{300 * degree, -60 * degree, "GALACTIC"}, {15.5557595692 * degree, -57.0668124306 * degree, "FK5"}},
      {{300 * degree, -60 * degree, "GALACTIC"}, {15.5557624758 * degree, -57.0668133834 * degree, "ICRS"}},
      {{300 * degree, -60 * degree, "SUPERGAL"}, {73.1013140578 * degree, -11.8105484435 * degree, "FK5"}},
      {{300 * degree, -60 * degree, "SUPERGAL"}, {73.1013085385 * degree, -11.8105438892 * degree, "ICRS"}},
  };
  for (const auto& [galactic, equatorial] : values) {
    const double bound_rad = (equatorial.frame == "FK5" ? 1e-6 : 0.031) * arcsec;
    BOOST_TEST(distance_rad(in_frame(galactic, equatorial.frame), equatorial) < bound_rad);
    BOOST_TEST(distance_rad(in_frame(equatorial, galactic.frame), galactic) < bound_rad);
  }
}

BOOST_AUTO_TEST_CASE(frames_lie_to_one_another_as_they_are_defined) {
  // The pole of Galactic coordinates and the origin of their longitude (ESA 1997, vol. 1, section 1.5.3, to the digits given,
  // which are said of ICRS there, though they are those of J2000).
  BOOST_TEST(in_frame({192.85948 * degree, 27.12825 * degree, "ICRS"}, "GALACTIC").dec_rad > 90 * degree - 0.03 * arcsec);
  BOOST_TEST(distance_rad(in_frame({266.40499 * degree, -28.93617 * degree, "ICRS"}, "GALACTIC"), {0, 0, "GALACTIC"}) <
             0.05 * arcsec);
  // The same pole as it is defined in B1950 (Blaauw et al. 1960, MNRAS 121, 123).
  BOOST_TEST(in_frame({192.25 * degree, 27.4 * degree, "FK4"}, "GALACTIC").dec_rad > 90 * degree - 1 * arcsec);
  // ICRS and J2000 are 23 milliarcseconds apart (Hilton & Hohenkerk 2004, A&A 413, 765).
  const SkyDirection icrs{1, 0.5, "ICRS"}, j2000 = in_frame(icrs, "FK5");
  BOOST_TEST(distance_rad({j2000.ra_rad, j2000.dec_rad, "ICRS"}, icrs) < 0.03 * arcsec);
  BOOST_TEST(distance_rad({j2000.ra_rad, j2000.dec_rad, "ICRS"}, icrs) > 0.001 * arcsec);
}

BOOST_AUTO_TEST_CASE(frames_that_images_have_not_lie_as_they_are_defined) {
  // The pole of the ecliptic of J2000, at its obliquity of 84381.448″ (Lieske et al. 1977, A&A 58, 1), and the pole of
  // supergalactic coordinates (de Vaucouleurs et al. 1991, RC3, volume I, section 1.2).
  BOOST_TEST(in_frame({270 * degree, 90 * degree - 84381.448 * arcsec, "FK5"}, "ECLIPTIC").dec_rad >
             90 * degree - 0.1 * arcsec);
  BOOST_TEST(in_frame({47.37 * degree, 6.32 * degree, "GALACTIC"}, "SUPERGAL").dec_rad > 90 * degree - 1 * arcsec);
  // The VLA's B1950 and B1950 differ by less than their equinoxes' corrections, an arcsecond.
  const SkyDirection vla = in_frame({1, 0.5, "B1950_VLA"}, "FK4");
  BOOST_TEST(distance_rad(vla, {1, 0.5, "FK4"}) < 1 * arcsec);
}

BOOST_AUTO_TEST_CASE(frames_that_nobody_knows_are_refused) {
  for (const char* name : {"", "J2000", "icrs", "AZEL"}) {
    BOOST_CHECK_THROW(in_frame({0, 0, "ICRS"}, name), std::invalid_argument);
    BOOST_CHECK_THROW(in_frame({0, 0, name}, "ICRS"), std::invalid_argument);
  }
}

BOOST_AUTO_TEST_SUITE_END()
