// Several MeasurementSets as one.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(several_sets)

using namespace testing;

namespace {

/// Of another telescope, date, band and feed.
class OtherSet : public SmallSet {
 public:
  explicit OtherSet(const imager::SkyDirection& centre = small_observation().fields.front().phase_centre)
      : SmallSet(other(centre)) {
    store_correlations({5, 6, 7, 8});
  }

 private:
  static SimulatedObservation other(const imager::SkyDirection& centre) {
    SimulatedObservation observation = small_observation();
    observation.fields.front().phase_centre = centre;
    observation.telescope = "VLBA";
    observation.fields.front().name = "AGAIN";
    for (double& f : observation.frequency_hz) f += 0.5e9;
    for (double& t : observation.time_mjd_s) t += 86400;
    return observation;
  }
};

MeasurementSet both(const SmallSet& first, const SmallSet& second, const std::string& column = "DATA") {
  return {std::vector<std::string>{first.path(), second.path()}, {}, column};
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_read_is_the_samples_of_one_after_those_of_the_other) {
  const SmallSet first;
  const OtherSet second;
  const MeasurementSet sets = both(first, second);
  AllSamples expected = read_all(MeasurementSet(first.path(), {}, "DATA"));
  const AllSamples more = read_all(MeasurementSet(second.path(), {}, "DATA")), all = read_all(sets);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(expected.uvw_m, more.uvw_m);
  append(expected.frequency_hz, more.frequency_hz);
  append(expected.visibility, more.visibility);
  append(expected.weight, more.weight);
  BOOST_TEST((all.uvw_m == expected.uvw_m));
  BOOST_TEST((all.frequency_hz == expected.frequency_hz));
  BOOST_TEST((all.visibility == expected.visibility));
  BOOST_TEST((all.weight == expected.weight));
  BOOST_TEST(sets.rows() == 2 * rows);
  BOOST_TEST(sets.samples() == 2 * rows * channels);
  BOOST_TEST(all.counts.used == 2 * rows * channels);
}

/// In whatever order they are named: the first named is observed last.
BOOST_AUTO_TEST_CASE(each_set_may_have_a_selection_of_its_own) {
  const SmallSet first;
  const OtherSet second;
  const Selection one_channel{"", "0:0"};
  const std::size_t channels_of_first = read_all(MeasurementSet(first.path(), one_channel, "DATA")).visibility.size();
  for (const bool swapped : {false, true}) {
    std::vector<std::string> paths{first.path(), second.path()}, windows{"0:0", ""};
    if (swapped) std::swap(paths[0], paths[1]), std::swap(windows[0], windows[1]);
    const MeasurementSet sets(paths, {"", PerSet(windows)}, "DATA");
    AllSamples expected = read_all(MeasurementSet(first.path(), one_channel, "DATA"));
    const AllSamples more = read_all(MeasurementSet(second.path(), {}, "DATA")), all = read_all(sets);
    expected.visibility.insert(expected.visibility.end(), more.visibility.begin(), more.visibility.end());
    BOOST_TEST((all.visibility == expected.visibility));
    BOOST_TEST(more.visibility.size() > channels_of_first);
  }
}

BOOST_AUTO_TEST_CASE(there_is_a_selection_for_all_sets_or_one_for_each) {
  const SmallSet first;
  const OtherSet second;
  for (const std::vector<std::string>& scans : {std::vector<std::string>{"1", "1", "1"}, {}, {"1"}}) {
    Selection selection;
    selection.scan = PerSet(scans);
    const bool fits = scans.size() < 2;
    BOOST_TEST(selection.scan.fits(2) == fits);
    if (fits) continue;
    BOOST_CHECK_EXCEPTION(MeasurementSet(std::vector{first.path(), second.path()}, selection, "DATA"), std::invalid_argument,
                          [](const std::invalid_argument& error) {
                            return std::string(error.what()) ==
                                   "--scan: 3 expressions for 2 sets; expected one for all, or one for each";
                          });
  }
}

BOOST_AUTO_TEST_CASE(the_observation_is_that_of_the_first_with_the_band_of_all) {
  const SmallSet first;
  const OtherSet second;
  const imager::Observation seen = both(first, second).observation();
  BOOST_TEST(seen.telescope == "EVLA");
  BOOST_TEST(seen.object == "SIMULATED");
  BOOST_TEST(seen.date_obs == "2014-02-24T23:06:35.000");
  BOOST_TEST(seen.frequency_hz == 1.2525e9);
  BOOST_TEST(seen.bandwidth_hz == 0.506e9);
}

BOOST_AUTO_TEST_CASE(the_reach_is_the_largest_and_the_coordinates_are_those_of_all) {
  const SmallSet first;
  const OtherSet second;
  const MeasurementSet sets = both(first, second), last(second.path(), {}, "DATA");
  BOOST_TEST(sets.reach().max_abs_u == last.reach().max_abs_u);
  std::size_t seen = 0;
  sets.visit_coordinates([&](const imager::SampleCoordinates& some) { seen += some.rows(); });
  BOOST_TEST(seen == 2 * rows);
}

BOOST_AUTO_TEST_CASE(phase_centres_that_differ_are_an_error_that_names_sets_and_fields) {
  const SmallSet first;
  const OtherSet rounded({1.25, -0.5 + 1e-14, "FK5"}), near({1.25, -0.5 + 2e-5, "FK5"}), far({1.25, -0.5 + 0.001, "FK5"});
  BOOST_TEST(both(first, rounded).rows() == 2 * rows);
  BOOST_TEST(contains(error_of([&] { both(first, near); }), "4.13 arcsec apart"));  // a 300th of the beam
  const std::string error = error_of([&] { both(first, far); });
  BOOST_TEST(contains(error, first.path() + " (field SIMULATED)"));
  BOOST_TEST(contains(error, far.path() + " (field AGAIN)"));
  BOOST_TEST(contains(error, "3.44 arcmin apart"));
  BOOST_TEST(contains(error, "--phasecenter"));
  BOOST_TEST(!contains(error, "\n"));
}

BOOST_AUTO_TEST_CASE(each_set_may_have_a_data_column_of_its_own) {
  const SmallSet first, second;
  second.modify([](casacore::MeasurementSet& set) { set.renameColumn("OTHER_DATA", "DATA"); });
  BOOST_TEST(read_all(both(first, second, "data,OTHER_DATA")).counts.used == 2 * rows * channels);
  const std::string missing = error_of([&] { both(first, second); });
  BOOST_TEST(contains(missing, second.path() + " has no visibilities in a column 'DATA'"));
  BOOST_TEST(contains(error_of([&] { both(first, second, "data,model,DATA"); }),
                      "names 3 columns; expected one, or one for each of 2 sets"));
}

BOOST_AUTO_TEST_CASE(an_error_names_the_set_it_is_in) {
  const SmallSet first, second;
  second.put("DATA_DESC_ID", 7, 4);
  const std::string error = error_of([&] { both(first, second); });
  BOOST_TEST(contains(error, second.path()));
  BOOST_TEST(!contains(error, first.path()));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
