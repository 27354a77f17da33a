// Where rows' antennas pointed as the table POINTING says it.
#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "tests/ms_io/one_of.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(row_pointings)

using namespace testing;

namespace {

constexpr double start_s = 4.9e9, row_s = 10;  // TIME of the first rows, and INTERVAL of all

struct Entry {
  int antenna = 0;
  double time_s = 0;
  double interval_s = 0;
  std::vector<double> direction;  ///< longitude, latitude, and their rates
};

void write_pointing(const SmallSet& set, const std::vector<Entry>& entries,
                    casacore::MDirection::Types frame = casacore::MDirection::J2000) {
  set.modify([&](casacore::MeasurementSet& table) {
    casacore::MSPointingColumns columns(table.pointing());
    if (table.pointing().nrow() == 0) columns.setDirectionRef(frame);
    for (const Entry& entry : entries) {
      const casacore::rownr_t row = table.pointing().nrow();
      table.pointing().addRow();
      columns.antennaId().put(row, entry.antenna);
      columns.time().put(row, entry.time_s);
      columns.timeOrigin().put(row, start_s);
      columns.interval().put(row, entry.interval_s);
      columns.numPoly().put(row, static_cast<int>(entry.direction.size() / 2) - 1);
      const casacore::IPosition shape(2, 2, static_cast<ssize_t>(entry.direction.size() / 2));
      columns.direction().put(row, casacore::Vector<double>(entry.direction).reform(shape));
      columns.target().put(row, casacore::Vector<double>(entry.direction).reform(shape));
      columns.tracking().put(row, true);
    }
  });
}

Selection by_pointing(double tolerance_rad) {
  Selection selection;
  selection.sights = true;
  selection.pointing_tolerance_rad = tolerance_rad;
  return selection;
}

/// A row and where it was found to point.
struct PointedRow {
  double time_s = 0;
  int one = 0;
  int other = 0;
  int number = 0;
  imager::SkyDirection direction;
};

/// u is the row's number + 1, and integrations follow each other.
std::vector<PointedRow> rows_of(const MeasurementSet& set) {
  std::vector<PointedRow> found;
  const auto stream = set.open();
  while (const auto block = stream->next())
    for (std::size_t r = 0; r < block->rows(); ++r) {
      const imager::RowSight& sight = block->sights.at(r);
      const auto row = static_cast<std::size_t>(std::lround(block->uvw_m[3 * r]) - 1);
      found.push_back({start_s + row_s * static_cast<double>(row / baselines), sight.antenna_one, sight.antenna_other,
                       sight.field, set.sight_table().pointings.at(static_cast<std::size_t>(sight.field)).direction});
    }
  return found;
}

double angle(const imager::SkyDirection& one, double ra_rad, double dec_rad) {
  const double east = one.ra_rad - ra_rad;
  return 2 * std::asin(std::sqrt(std::pow(std::sin((one.dec_rad - dec_rad) / 2), 2) +
                                 std::cos(one.dec_rad) * std::cos(dec_rad) * std::pow(std::sin(east / 2), 2)));
}

/// A scan along a meridian; antennas lie a little apart.
double scanned_dec_rad(double time_s, int antenna) {
  return -0.5 + 1e-4 * (time_s - start_s) + 1e-6 * antenna;
}

/// An entry each 4 s that never falls on the time of a row.
std::vector<Entry> scan(double interval_s = 4) {
  std::vector<Entry> entries;
  for (int antenna = 3; antenna >= 0; --antenna)
    for (int k = -3; k < 15; ++k) {
      const double time_s = start_s + 4 * k + 1.5;
      entries.push_back({antenna, time_s, interval_s, {1.25, scanned_dec_rad(time_s, antenna)}});
    }
  return entries;
}

}  // namespace

BOOST_AUTO_TEST_CASE(antennas_stay_where_an_entry_has_them_as_long_as_its_interval) {
  const SmallSet set;
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 4; ++antenna) {
    entries.push_back({antenna, start_s + 5, 20, {1.25, -0.5}});
    entries.push_back({antenna, start_s + 30, 30, {1.27, -0.49}});
  }
  write_pointing(set, entries);
  const MeasurementSet opened(set.path(), by_pointing(1e-4), "DATA");
  BOOST_REQUIRE_EQUAL(opened.sight_table().pointings.size(), 2U);
  BOOST_TEST(opened.sight_table().pointings[1].field == "0 (SIMULATED) at 2014-02-24T23:07:00.000");
  BOOST_TEST(opened.sight_table().pointings[1].id == 0);
  for (const PointedRow& row : rows_of(opened)) {
    const bool first = row.time_s < start_s + 15;
    BOOST_TEST(row.number == (first ? 0 : 1));
    BOOST_TEST(angle(row.direction, first ? 1.25 : 1.27, first ? -0.5 : -0.49) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(rows_of_a_scan_count_within_the_tolerance_of_where_their_antennas_pointed) {
  const SmallSet set;
  write_pointing(set, scan());
  for (const double tolerance_rad : {1e-8, 1.2e-3, 2.1e-3, 1.0}) {
    const MeasurementSet opened(set.path(), by_pointing(tolerance_rad), "DATA");
    std::set<int> numbers;
    for (const PointedRow& row : rows_of(opened)) {
      const double mean = (scanned_dec_rad(row.time_s, row.one) + scanned_dec_rad(row.time_s, row.other)) / 2;
      BOOST_TEST(angle(row.direction, 1.25, mean) < tolerance_rad + 1e-12);
      numbers.insert(row.number);
    }
    BOOST_TEST(numbers.size() == opened.sight_table().pointings.size());
    // 1 mrad of scan between integrations; means of antennas lie 0.5 to 2.5 µrad from the first's, one of them twice.
    const std::size_t expected = tolerance_rad < 1e-6   ? 5 * integrations
                                 : tolerance_rad < 2e-3 ? 3
                                 : tolerance_rad < 0.1  ? 2
                                                        : 1;
    BOOST_TEST(numbers.size() == expected);
  }
}

BOOST_AUTO_TEST_CASE(entries_without_an_interval_are_samples_too) {
  const SmallSet set;
  write_pointing(set, scan(-1));
  for (const PointedRow& row : rows_of(MeasurementSet(set.path(), by_pointing(1e-9), "DATA"))) {
    const double mean = (scanned_dec_rad(row.time_s, row.one) + scanned_dec_rad(row.time_s, row.other)) / 2;
    BOOST_TEST(angle(row.direction, 1.25, mean) < 1e-9);
  }
}

BOOST_AUTO_TEST_CASE(shares_and_parts_of_several_sets_have_the_pointings_of_the_whole) {
  const SmallSet first, second;
  first.add_spectral_window();
  for (const SmallSet* set : {&first, &second}) write_pointing(*set, scan());
  const MeasurementSet whole(std::vector<std::string>{first.path(), second.path()}, by_pointing(1.2e-3), "DATA");
  BOOST_REQUIRE_EQUAL(whole.sight_table().pointings.size(), 6U);
  std::map<std::tuple<double, int, int>, int> expected, together;  // antennas of the sets have different numbers
  const auto note = [](const MeasurementSet& set, std::map<std::tuple<double, int, int>, int>& numbers) {
    for (const PointedRow& row : rows_of(set)) numbers[{row.time_s, row.one, row.other}] = row.number;
  };
  note(whole, expected);
  BOOST_TEST(expected.size() == 2 * rows);
  for (const auto& [row, number] : expected) BOOST_TEST((number >= 3) == (std::get<1>(row) >= static_cast<int>(antennas)));
  for (int rank = 0; rank < 3; ++rank) {
    const OneOf ranks(rank, 3);
    for (const double hz : {1e9, 2e9})
      if (const auto part = whole.share(ranks)->part({hz, hz + 1e7})) note(*part, together);
  }
  BOOST_TEST((together == expected));
}

BOOST_AUTO_TEST_CASE(entries_may_have_rates) {
  const SmallSet set;
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 4; ++antenna) entries.push_back({antenna, start_s + 20, 60, {1.25, -0.5, 2e-5, 1e-4}});
  write_pointing(set, entries);
  for (const PointedRow& row : rows_of(MeasurementSet(set.path(), by_pointing(1e-9), "DATA"))) {
    const double since_s = row.time_s - start_s;
    BOOST_TEST(angle(row.direction, 1.25 + 2e-5 * since_s, -0.5 + 1e-4 * since_s) < 1e-9);
  }
}

/// The vertical of an antenna 32 km away is turned by 5 mrad.
BOOST_AUTO_TEST_CASE(directions_above_the_horizon_are_those_of_each_antenna) {
  SimulatedObservation observation = small_observation();
  observation.antenna_itrf_m[3] = {-1601185.0 + 30e3, -5041977.0 - 10e3, 3554875.0};
  const SmallSet set(observation);
  const casacore::MDirection field(casacore::MVDirection(1.25, -0.5), casacore::MDirection::J2000);
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 4; ++antenna)
    for (const double time_s : observation.time_mjd_s) {
      const auto& itrf = observation.antenna_itrf_m[static_cast<std::size_t>(antenna)];
      const casacore::MPosition place(casacore::MVPosition(itrf[0], itrf[1], itrf[2]), casacore::MPosition::ITRF);
      const casacore::MeasFrame here(casacore::MEpoch(casacore::Quantity(time_s, "s"), casacore::MEpoch::UTC), place);
      const casacore::Vector<double> angles =
          casacore::MDirection::Convert(field, casacore::MDirection::Ref(casacore::MDirection::AZELGEO, here))()
              .getAngle("rad")
              .getValue();
      entries.push_back({antenna, time_s, 10, angles.tovector()});
    }
  write_pointing(set, entries, casacore::MDirection::AZELGEO);
  for (const PointedRow& row : rows_of(MeasurementSet(set.path(), by_pointing(1e-7), "DATA")))
    BOOST_TEST(angle(row.direction, 1.25, -0.5) < 1e-9);  // as far as casacore's way there and back is exact
}

BOOST_AUTO_TEST_CASE(antennas_that_point_apart_count_as_their_mean_and_users_are_told) {
  const SmallSet set;
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 4; ++antenna)
    entries.push_back({antenna, start_s + 20, 60, {1.25, antenna == 3 ? -0.499 : -0.5}});
  write_pointing(set, entries);
  const MeasurementSet opened(set.path(), by_pointing(1e-4), "DATA");
  for (const PointedRow& row : rows_of(opened)) BOOST_TEST(angle(row.direction, 1.25, row.other == 3 ? -0.4995 : -0.5) < 1e-12);
  BOOST_REQUIRE_EQUAL(opened.remarks().size(), 1U);
  BOOST_TEST(opened.remarks()[0] == "antennas of 15 rows of " + set.path() +
                                        " pointed up to 3.44 arcmin apart, more than the tolerance of 20.6 arcsec: each row "
                                        "counts as seen from the middle between its two antennas' directions");
}

BOOST_AUTO_TEST_CASE(flagged_rows_found_no_pointing) {
  const SmallSet set;
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 4; ++antenna) entries.push_back({antenna, start_s + 40, 30, {1.25, -0.5}});
  write_pointing(set, entries);
  for (std::size_t row = 0; row < 3 * baselines; ++row) set.put("FLAG_ROW", row, true);  // which POINTING says nothing of
  const MeasurementSet opened(set.path(), by_pointing(1e-4), "DATA");
  BOOST_TEST(opened.sight_table().pointings.size() == 1U);
  const auto block = opened.open()->next();
  for (std::size_t row = 0; row < rows; ++row) BOOST_TEST(block->sights.at(row).field == (row < 3 * baselines ? -1 : 0));
}

BOOST_AUTO_TEST_CASE(what_pointing_does_not_say_is_an_error_that_names_it) {
  const auto error = [](const SmallSet& set) {
    return error_of([&] { MeasurementSet(set.path(), by_pointing(1e-4), "DATA"); });
  };
  const SmallSet set;
  const std::string remedy = "; expected entries of all antennas at the times of their rows, or no --usepointing";
  BOOST_TEST(error(set) == set.path() + ": POINTING has no rows" + remedy);
  std::vector<Entry> entries;
  for (int antenna = 0; antenna < 3; ++antenna) entries.push_back({antenna, start_s + 10, 40, {1.25, -0.5}});
  write_pointing(set, entries);
  BOOST_TEST(error(set) == set.path() + ": POINTING has no entries of antenna 3 (A3), which the selected rows have" + remedy);
  write_pointing(set, {{3, start_s + 10, 10, {1.25, -0.5}}});  // it reaches 10 s
  const std::string lack = set.path() + ": POINTING has no entries that tell where antenna 3 (A3) pointed at ";
  BOOST_TEST(error(set) == lack + "2014-02-24T23:07:10.000" + remedy);
  write_pointing(set, {{7, start_s + 40, 40, {1.25, -0.5}}});
  BOOST_TEST(error(set) == lack + "2014-02-24T23:07:10.000, and 1 of antennas that ANTENNA lacks" + remedy);
  set.modify([](casacore::MeasurementSet& table) { table.rwKeywordSet().removeField("POINTING"); });
  BOOST_TEST(error(set) == set.path() + " has no table POINTING" + remedy);
  BOOST_CHECK_THROW(MeasurementSet(set.path(), by_pointing(0), "DATA"), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
