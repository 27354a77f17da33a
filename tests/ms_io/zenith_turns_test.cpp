#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCPosition.h>
#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "ms_io/model_writer.h"
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
  const casacore::MDirection field(casacore::Quantity(o.fields.front().phase_centre.ra_rad, "rad"),
                                   casacore::Quantity(o.fields.front().phase_centre.dec_rad, "rad"),
                                   casacore::MDirection::J2000);
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

BOOST_AUTO_TEST_CASE(predictions_are_told_how_their_rows_saw_the_sky) {
  SimulatedObservation o = small_observation();
  o.fields.push_back({"OTHER", {1.26, -0.49, "FK5"}});
  for (std::size_t t = 0; t < integrations; ++t) o.time_mjd_s[t] = 4.9e9 + 3600.0 * static_cast<double>(t);
  const SmallSet set(o);
  Selection selection;
  selection.phase_centre = o.fields.front().phase_centre;
  const std::vector<float> turns = MeasurementSet(set.path(), selection, "DATA").zenith_turns();
  std::vector<imager::RowSight> seen;
  const auto note = [&](const imager::SampleCoordinates& at) {
    seen.insert(seen.end(), at.sights.begin(), at.sights.end());
    return StokesVisibilities(std::vector<std::complex<double>>(at.samples()));
  };
  write_model(set.path(), selection, {"TOLD"}, note, {}, {7, 1, o.fields.front().phase_centre});  // a row at a time
  BOOST_REQUIRE_EQUAL(seen.size(), rows);
  std::size_t row = 0;
  for (std::size_t t = 0; t < integrations; ++t)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b, ++row) {
        const auto is_row = [&](const imager::RowSight& sight) {
          return sight.antenna_one == a && sight.antenna_other == b && sight.field == static_cast<int>(t % 2) &&
                 std::count(turns.begin(), turns.end(), sight.zenith_rad) > 0;
        };
        BOOST_TEST(std::count_if(seen.begin(), seen.end(), is_row) == (t % 2 == 0 ? 3 : 2));
      }
  write_model(set.path(), selection, {"UNTOLD"},
              [](const imager::SampleCoordinates& at) {
                BOOST_TEST(at.sights.empty());
                return StokesVisibilities(std::vector<std::complex<double>>(at.samples()));
              },
              {});
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
