#include "ms_io/beam_rows.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(beam_rows)

using namespace testing;

namespace {

/// Makes antennas 2 and 3 12 m wide; the others have 25 m.
void make_mixed(const SmallSet& set) {
  set.modify([](casacore::MeasurementSet& table) {
    casacore::ScalarColumn<double> diameter(table.antenna(), "DISH_DIAMETER");
    diameter.put(2, 12);
    diameter.put(3, 12);
  });
}

BeamRows rows_of(const SmallSet& set, const Selection& selection = {}) {
  return MeasurementSet(set.path(), selection, "DATA").beam_rows();
}

}  // namespace

BOOST_AUTO_TEST_CASE(antennas_of_one_sort_need_no_pairs) {
  const SmallSet set;
  const BeamRows rows = rows_of(set);
  BOOST_REQUIRE_EQUAL(rows.sorts.size(), 1U);
  BOOST_TEST(rows.sorts[0].telescope == "EVLA");
  BOOST_TEST(rows.sorts[0].diameter_m == 25.0);
  BOOST_TEST(rows.sorts[0].name == "A0");
  BOOST_TEST(rows.pairs.empty());
  BOOST_TEST(rows.beam_offset_rad() == 0.0);
  BOOST_REQUIRE_EQUAL(rows.pointings.size(), 1U);
  BOOST_TEST(rows.pointings[0].field == "0 (SIMULATED)");
  BOOST_TEST(rows.pointings[0].direction.ra_rad == 1.25);
  BOOST_TEST(rows.pointings[0].direction.dec_rad == -0.5);
}

BOOST_AUTO_TEST_CASE(pairs_stand_in_the_order_of_blocks) {
  const SmallSet set;
  make_mixed(set);
  set.add_spectral_window();  // every third row is in blocks of its own
  const MeasurementSet opened(set.path(), {}, "DATA");
  const BeamRows rows = opened.beam_rows();
  BOOST_REQUIRE_EQUAL(rows.sorts.size(), 2U);
  BOOST_REQUIRE_EQUAL(rows.pairs.size(), antennas * (antennas - 1) / 2 * integrations);
  const bool narrow_first = rows.sorts[0].diameter_m == 12;
  const AllSamples all = read_all(opened);
  for (std::size_t r = 0; r < rows.pairs.size(); ++r) {
    // u is the row's number + 1, and baselines run 01 02 03 12 13 23.
    const auto baseline = (std::lround(all.uvw_m[3 * r]) - 1) % static_cast<long>(baselines);
    const bool one_narrow = baseline == 5, other_narrow = baseline != 0;
    BOOST_TEST((rows.pairs[r].one == (one_narrow == narrow_first ? 0 : 1)));
    BOOST_TEST((rows.pairs[r].other == (other_narrow == narrow_first ? 0 : 1)));
  }
}

BOOST_AUTO_TEST_CASE(antennas_count_where_rows_that_are_selected_have_them) {
  const SmallSet set;
  make_mixed(set);
  Selection selection;
  selection.antenna = "A0&A1";
  const BeamRows rows = rows_of(set, selection);
  BOOST_REQUIRE_EQUAL(rows.sorts.size(), 1U);
  BOOST_TEST(rows.sorts[0].diameter_m == 25.0);
}

BOOST_AUTO_TEST_CASE(antennas_point_to_the_reference_direction_wherever_visibilities_are_phased_to) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& table) {
    casacore::Matrix<double> shifted(2, 1);
    shifted(0, 0) = 1.3;
    shifted(1, 0) = -0.45;
    casacore::MSFieldColumns(table.field()).phaseDir().put(0, shifted);
  });
  Selection selection;
  for (const bool shift : {false, true}) {
    if (shift) selection.phase_centre = imager::SkyDirection{1.2, -0.4, "FK5"};
    const BeamRows rows = rows_of(set, selection);
    BOOST_TEST(rows.pointings.at(0).direction.ra_rad == 1.25);
    BOOST_TEST(rows.pointings.at(0).direction.dec_rad == -0.5);
  }
  // ICRS lies some 20 mas from J2000.
  selection.phase_centre = imager::SkyDirection{1.2, -0.4, "ICRS"};
  const imager::SkyDirection direction = rows_of(set, selection).pointings.at(0).direction;
  BOOST_TEST(direction.frame == "ICRS");
  BOOST_TEST(std::abs(direction.ra_rad - 1.25) < 5e-7);
  BOOST_TEST(std::abs(direction.dec_rad + 0.5) < 5e-7);
}

BOOST_AUTO_TEST_CASE(every_field_that_is_selected_has_its_pointing_seen_from_the_images_centre) {
  const SmallSet first, second;
  first.add_field(1.26, -0.51);
  Selection selection;
  selection.phase_centre = imager::SkyDirection{1.25, -0.51, "FK5"};
  const auto pointings = [&](const std::string& field) {
    selection.field = field;
    return MeasurementSet({first.path(), second.path()}, selection, "DATA").field_pointings();
  };
  const std::vector<FieldPointing> all = pointings("");
  BOOST_REQUIRE_EQUAL(all.size(), 3U);
  BOOST_TEST(all[0].field == "0 (SIMULATED)");
  BOOST_TEST(all[1].field == "1 (OTHER)");
  BOOST_TEST(all[1].name == "OTHER");
  BOOST_TEST(all[1].direction.ra_rad == 1.26);
  BOOST_TEST(all[1].set == first.path());
  BOOST_TEST(all[2].set == second.path());
  // The chord along right ascension, and the difference of declinations.
  BOOST_TEST(std::abs(all[1].from_centre_rad - 2 * std::asin(std::cos(0.51) * std::sin(0.005))) < 1e-12);
  BOOST_TEST(std::abs(all[0].from_centre_rad - 0.01) < 1e-12);
  BOOST_REQUIRE_EQUAL(pointings("0").size(), 2U);
  BOOST_TEST(pointings("0")[0].field == "0 (SIMULATED)");
  BOOST_TEST(all[0].smallest_dish_m == small_observation().dish_diameter_m.front());
  first.modify([](casacore::MeasurementSet& table) {
    casacore::ScalarColumn<double>(table.antenna(), "DISH_DIAMETER").fillColumn(0);
    casacore::ScalarColumn<double>(table.antenna(), "DISH_DIAMETER").put(1, 12);
  });
  BOOST_TEST(pointings("")[0].smallest_dish_m == 12);
}

BOOST_AUTO_TEST_CASE(rows_of_each_pair_of_sorts_are_counted_by_field) {
  const SmallSet set;
  make_mixed(set);
  set.add_field(1.26, -0.51);  // every second row
  set.put("ANTENNA2", 4, 1);   // an antenna with itself
  Selection selection;
  selection.phase_centre = imager::SkyDirection{1.25, -0.5, "FK5"};
  const BeamRows beams = rows_of(set, selection);
  BOOST_REQUIRE_EQUAL(beams.pointings.size(), 2U);
  std::map<std::pair<double, double>, std::uint64_t> expected[2], counted[2];
  const casacore::MeasurementSet table(set.path());
  const casacore::ScalarColumn<int> one(table, "ANTENNA1"), other(table, "ANTENNA2");
  const auto diameter_m = [](int antenna) { return antenna < 2 ? 25.0 : 12.0; };
  for (casacore::rownr_t row = 0; row < table.nrow(); ++row)
    if (one(row) != other(row)) ++expected[row % 2][{diameter_m(one(row)), diameter_m(other(row))}];
  for (std::size_t field = 0; field < 2; ++field)
    for (const SortRows& some : beams.pointings[field].rows)
      counted[field][{beams.sorts[some.pair.one].diameter_m, beams.sorts[some.pair.other].diameter_m}] += some.rows;
  BOOST_TEST((counted[0] == expected[0]));
  BOOST_TEST((counted[1] == expected[1]));
}

BOOST_AUTO_TEST_CASE(offsets_count_of_feeds_that_are_used_as_the_mean_of_their_receptors) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& table) {
    casacore::ArrayColumn<double> offset(table.feed(), "BEAM_OFFSET");
    casacore::Matrix<double> of_receptors(2, 2, 0.0);
    of_receptors(0, 0) = 3e-3;
    of_receptors(0, 1) = 3e-3;
    of_receptors(1, 0) = -4e-3;
    of_receptors(1, 1) = -4e-3;
    offset.put(1, of_receptors);
    casacore::Matrix<double> squint(2, 2, 0.0);  // which a mean of both hands does not have
    squint(0, 0) = 1e-3;
    squint(0, 1) = -1e-3;
    offset.put(0, squint);
  });
  const std::vector<FeedOffset> feeds = rows_of(set).feeds;  // of all antennas the same but for one
  BOOST_REQUIRE_EQUAL(feeds.size(), 2U);
  BOOST_TEST(feeds[0].rad() == 0.0);
  BOOST_TEST(feeds[1].antenna == 1);
  BOOST_TEST(std::abs(feeds[1].x_rad - 3e-3) < 1e-15);
  BOOST_TEST(std::abs(feeds[1].y_rad + 4e-3) < 1e-15);
  BOOST_TEST(std::abs(rows_of(set).beam_offset_rad() - 5e-3) < 1e-15);
  BOOST_TEST(std::abs(MeasurementSet(set.path(), {}, "DATA").beam_offset_rad() - 5e-3) < 1e-15);
  Selection without;
  without.antenna = "A0&A2";
  BOOST_TEST(rows_of(set, without).beam_offset_rad() == 0.0);
  set.modify([](casacore::MeasurementSet& table) { casacore::ScalarColumn<int>(table.feed(), "FEED_ID").put(1, 7); });
  BOOST_TEST(rows_of(set).beam_offset_rad() == 0.0);
  set.modify([](casacore::MeasurementSet& table) {
    casacore::ScalarColumn<int>(table.feed(), "FEED_ID").put(1, 0);
    casacore::ScalarColumn<int>(table.feed(), "SPECTRAL_WINDOW_ID").put(1, 3);  // which is not selected
  });
  BOOST_TEST(rows_of(set).beam_offset_rad() == 0.0);
}

BOOST_AUTO_TEST_CASE(rows_of_antennas_that_there_are_not_are_refused) {
  const SmallSet set;
  set.put("ANTENNA2", 3, 17);
  BOOST_TEST(contains(error_of([&] { rows_of(set); }), "has rows of antenna 17, but ANTENNA has 4 rows"));
}

BOOST_AUTO_TEST_CASE(real_sets_tell_what_they_were_observed_with) {
  using misfit::testing::Unpacked;
  const Unpacked atca("atca_sim_tileddata"), lofar("lofar_3c295_snapshot");
  if (!atca.present() || !lofar.present()) return;
  const BeamRows five_beams = MeasurementSet(atca / "atca_sim_tileddata.ms", {}, "DATA").beam_rows();
  BOOST_TEST(five_beams.sorts.at(0).telescope == "ATCA");
  BOOST_TEST(std::abs(five_beams.beam_offset_rad() - std::hypot(0.25, 0.25) * 3.14159265358979 / 180) <
             1e-8);  // as it is rounded there
  const BeamRows stations = MeasurementSet(lofar / "lofar_3c295_snapshot.ms", {}, "DATA").beam_rows();
  BOOST_TEST(stations.sorts.at(0).telescope == "LOFAR");
  BOOST_TEST(stations.sorts.size() > 1U);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
