#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCPosition.h>
#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(zenith_turns)

using namespace testing;

namespace {

/// The parallactic angle of the small set's field, by its hour angle and declination of date and the place's latitude.
double parallactic_angle(double time_s) {
  const SimulatedObservation o = small_observation();
  const auto& itrf = o.antenna_itrf_m.front();
  const casacore::MPosition place(casacore::MVPosition(itrf[0], itrf[1], itrf[2]), casacore::MPosition::ITRF);
  const casacore::MeasFrame frame(casacore::MEpoch(casacore::Quantity(time_s, "s"), casacore::MEpoch::UTC), place);
  const casacore::MDirection field(casacore::Quantity(o.phase_centre.ra_rad, "rad"),
                                   casacore::Quantity(o.phase_centre.dec_rad, "rad"), casacore::MDirection::J2000);
  const auto local = casacore::MDirection::Convert(field, casacore::MDirection::Ref(casacore::MDirection::HADEC, frame))()
                         .getAngle("rad")
                         .getValue();
  const double latitude = casacore::MPosition::Convert(place, casacore::MPosition::WGS84)().getAngle("rad").getValue()(1);
  return std::atan2(std::cos(latitude) * std::sin(local(0)),
                    std::sin(latitude) * std::cos(local(1)) - std::cos(latitude) * std::sin(local(1)) * std::cos(local(0)));
}

}  // namespace

BOOST_AUTO_TEST_CASE(dishes_that_follow_the_zenith_turn_by_the_parallactic_angle) {
  SimulatedObservation o = small_observation();
  for (std::size_t t = 0; t < integrations; ++t) o.time_mjd_s[t] = 4.9e9 + 3600.0 * static_cast<double>(t);
  const SmallSet set(o);
  const std::vector<float> turns = MeasurementSet(set.path(), {}, "DATA").zenith_turns();
  BOOST_REQUIRE_EQUAL(turns.size(), rows);
  for (std::size_t row = 0; row < rows; ++row) {
    // The pole of J2000 is 0.08° from that of 2014, and the place that of the VLA: a thousandth of a radian at this
    // declination.
    const double apart = turns[row] - parallactic_angle(o.time_mjd_s[row / baselines]);
    BOOST_TEST(std::abs(std::remainder(apart, 2 * M_PI)) < 2e-3);
  }
  BOOST_TEST(std::abs(turns.front() - turns.back()) > 0.3F);
}

BOOST_AUTO_TEST_CASE(dishes_on_other_mounts_do_not_turn) {
  for (const char* mount : {"EQUATORIAL", "equatorial", "ALT-AZ+ROTATOR", "X-Y"}) {
    const SmallSet set;
    set.modify([&](casacore::MeasurementSet& table) {
      casacore::ScalarColumn<casacore::String> column(table.antenna(), "MOUNT");
      for (casacore::rownr_t a = 0; a < antennas; ++a) column.put(a, mount);
    });
    for (const float turn : MeasurementSet(set.path(), {}, "DATA").zenith_turns()) BOOST_TEST(turn == 0.0F);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
