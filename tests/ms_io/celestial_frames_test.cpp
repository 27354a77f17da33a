#include "ms_io/celestial_frames.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

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

BOOST_AUTO_TEST_CASE(frames_lie_to_one_another_as_they_are_defined) {
  // The pole of Galactic coordinates and the origin of their longitude (ESA 1997, vol. 1, section 1.5.3, to the digits given).
  BOOST_TEST(in_frame({192.85948 * degree, 27.12825 * degree, "ICRS"}, "GALACTIC").dec_rad > 90 * degree - 1e-6 * arcsec);
  BOOST_TEST(distance_rad(in_frame({266.40499 * degree, -28.93617 * degree, "ICRS"}, "GALACTIC"), {0, 0, "GALACTIC"}) <
             0.05 * arcsec);
  // Where astropy 5.2 has the Crab, to the 0.03 arcsec by which ICRS differs from the J2000 that it goes through.
  BOOST_TEST(distance_rad(in_frame({83.6331 * degree, 22.0145 * degree, "ICRS"}, "GALACTIC"),
                          {184.55746619 * degree, -5.78434365 * degree, "GALACTIC"}) < 0.05 * arcsec);
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
