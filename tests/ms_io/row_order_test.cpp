// What is known of a set does not depend on the order of its rows.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <numeric>
#include <random>
#include <tuple>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(row_order)

using namespace testing;

namespace {

/// Two fields, two windows and two observations, days apart, of which the later stands first.
struct MixedSet : SmallSet {
  MixedSet() {
    add_field(1.25, -0.5);
    add_spectral_window();
    modify([](casacore::MeasurementSet& set) {
      casacore::ScalarColumn<double> time(set, "TIME");
      casacore::ScalarColumn<int> observation(set, "OBSERVATION_ID");
      set.observation().addRow(1);
      casacore::MSObservationColumns columns(set.observation());
      columns.telescopeName().put(1, "LATER");
      columns.observer().put(1, "somebody");
      for (casacore::rownr_t r = 0; r < rows; ++r) {
        const bool later = r < rows / 2;
        if (later) time.put(r, time(r) + 20 * 86400);
        observation.put(r, later ? 1 : 0);
      }
    });
  }
};

std::string shuffled(const SmallSet& set, const TemporaryFolder& folder, unsigned seed) {
  const casacore::MeasurementSet open(set.path());
  std::vector<casacore::rownr_t> order(open.nrow());
  std::iota(order.begin(), order.end(), casacore::rownr_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  const std::string copy = folder / ("shuffled" + std::to_string(seed) + ".ms");
  open(casacore::Vector<casacore::rownr_t>(order)).deepCopy(copy, casacore::Table::New, true);
  return copy;
}

auto described(const MeasurementSet& set) {
  const imager::Observation& o = set.observation();
  return std::tuple(o.phase_centre.ra_rad, o.phase_centre.dec_rad, o.phase_centre.frame, o.object, o.telescope, o.observer,
                    o.date_obs, o.frequency_hz, o.bandwidth_hz, o.spectral_frame);
}

std::vector<std::vector<double>> frequencies(const MeasurementSet& set) {
  std::vector<std::vector<double>> all;
  for (const SpectralWindow& window : set.spectral_windows()) all.push_back(window.frequency_hz);
  return all;
}

/// Of each row, in an order of their own.
std::vector<double> sorted_u(const MeasurementSet& set) {
  const AllSamples all = read_all(set);
  std::vector<double> u;
  for (std::size_t i = 0; i < all.uvw_m.size(); i += 3) u.push_back(all.uvw_m[i]);
  std::sort(u.begin(), u.end());
  return u;
}

}  // namespace

BOOST_AUTO_TEST_CASE(shuffled_rows_have_the_same_observation_windows_and_samples) {
  const MixedSet set;
  const TemporaryFolder folder;
  std::vector<Selection> selections(5);
  selections[1].spectral_frame = "LSRK";
  selections[2].spectral_window = "1,0";
  selections[2].spectral_frame = "BARYCENT";
  selections[3].phase_centre = imager::SkyDirection{1.26, -0.49, "ICRS"};
  selections[4].time_range = "00:00:00~23:59:59";  // of the earlier day
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::string other = shuffled(set, folder, seed);
    for (const Selection& selection : selections) {
      const MeasurementSet one(set.path(), selection, "DATA"), two(other, selection, "DATA");
      BOOST_CHECK(described(one) == described(two));
      BOOST_TEST(one.observation().telescope != "LATER");
      BOOST_CHECK(frequencies(one) == frequencies(two));
      BOOST_CHECK(sorted_u(one) == sorted_u(two));
    }
  }
}

BOOST_AUTO_TEST_CASE(windows_come_as_the_selection_lists_them_or_by_id) {
  const MixedSet set;
  const auto first_of = [&](const std::string& windows) {
    return frequencies(MeasurementSet(set.path(), {"", windows}, "DATA")).front().front();
  };
  BOOST_TEST(first_of("") == 1e9);
  BOOST_TEST(first_of("*") == 1e9);
  BOOST_TEST(first_of("0,1") == 1e9);
  BOOST_TEST(first_of("1,0") == 2e9);
  BOOST_TEST(first_of("1:2~3,0") == 2e9 + 2e6);
  BOOST_TEST(first_of("1:2~3,0,1:0") == 2e9);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
