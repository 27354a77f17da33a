// With what rows were observed, and in which direction, as blocks tell it.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>

#include "tests/ms_io/one_of.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(sight_table)

using namespace testing;

namespace {

SimulatedObservation hourly() {
  SimulatedObservation observation = small_observation();
  for (std::size_t t = 0; t < integrations; ++t) observation.time_mjd_s[t] = 4.9e9 + 3600.0 * static_cast<double>(t);
  return observation;
}

/// Fields phased to one direction, so that u tells rows apart, that point to different ones; every second row has each.
class TwoPointings : public SmallSet {
 public:
  explicit TwoPointings(const SimulatedObservation& observation = hourly()) : SmallSet(observation) {
    add_field(1.25, -0.5);
    modify([](casacore::MeasurementSet& set) {
      casacore::Matrix<double> direction(2, 1);
      direction(0, 0) = 1.26;
      direction(1, 0) = -0.49;
      casacore::MSFieldColumns(set.field()).referenceDir().put(1, direction);
    });
  }
};

Selection with_sights() {
  Selection selection;
  selection.sights = true;
  return selection;
}

/// By u, which is the row's number + 1.
std::map<long, imager::RowSight> sights_of(const MeasurementSet& set) {
  std::map<long, imager::RowSight> sights;
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    BOOST_TEST_REQUIRE(block->sights.size() == block->rows());
    for (std::size_t row = 0; row < block->rows(); ++row) sights[std::lround(block->uvw_m[3 * row]) - 1] = block->sights[row];
  }
  return sights;
}

bool same(const imager::RowSight& a, const imager::RowSight& b) {
  return a.antenna_one == b.antenna_one && a.antenna_other == b.antenna_other && a.field == b.field &&
         a.zenith_rad == b.zenith_rad;
}

}  // namespace

BOOST_AUTO_TEST_CASE(blocks_tell_what_the_columns_of_their_rows_say) {
  const TwoPointings set;
  set.add_spectral_window();  // rows of which alternate with those of the other, and are read with them
  const MeasurementSet opened(set.path(), with_sights(), "DATA");
  const SightTable& table = opened.sight_table();
  BOOST_REQUIRE_EQUAL(table.antennas.size(), antennas);
  BOOST_REQUIRE_EQUAL(table.pointings.size(), 2U);
  BOOST_TEST(table.pointings[1].direction.ra_rad == 1.26);
  const casacore::MeasurementSet columns(set.path());
  const casacore::ScalarColumn<int> one(columns, "ANTENNA1"), other(columns, "ANTENNA2"), field(columns, "FIELD_ID");
  const std::map<long, imager::RowSight> sights = sights_of(opened);
  BOOST_TEST(sights.size() == rows);
  for (const auto& [row, sight] : sights) {
    const auto r = static_cast<casacore::rownr_t>(row);
    BOOST_TEST(sight.antenna_one == one(r));
    BOOST_TEST(sight.antenna_other == other(r));
    BOOST_TEST(table.pointings[static_cast<std::size_t>(sight.field)].id == field(r));
  }
  std::size_t row = 0;
  const std::vector<float> turns = opened.zenith_turns();  // in the order of blocks
  const auto stream = opened.open();
  while (const auto block = stream->next())
    for (const imager::RowSight& sight : block->sights) BOOST_TEST(sight.zenith_rad == turns.at(row++));
  BOOST_TEST(sights.at(0).zenith_rad != sights.at(rows - 1).zenith_rad);
}

BOOST_AUTO_TEST_CASE(pointings_are_those_of_fields_that_are_selected) {
  const TwoPointings set;
  Selection selection = with_sights();
  selection.field = "1";
  const MeasurementSet opened(set.path(), selection, "DATA");
  BOOST_REQUIRE_EQUAL(opened.sight_table().pointings.size(), 1U);
  BOOST_TEST(opened.sight_table().pointings[0].id == 1);
  for (const auto& [row, sight] : sights_of(opened)) BOOST_TEST(sight.field == 0);
}

BOOST_AUTO_TEST_CASE(numbers_run_on_over_several_sets) {
  SimulatedObservation later = hourly();
  for (double& time_s : later.time_mjd_s) time_s += 86400;
  later.dish_diameter_m = {12};
  const TwoPointings first, second(later);
  const MeasurementSet both(std::vector<std::string>{second.path(), first.path()}, with_sights(), "DATA");
  const SightTable& table = both.sight_table();
  BOOST_REQUIRE_EQUAL(table.antennas.size(), 2 * antennas);
  BOOST_REQUIRE_EQUAL(table.pointings.size(), 4U);
  const auto alone = sights_of(MeasurementSet(second.path(), with_sights(), "DATA"));
  std::size_t seen = 0;
  const auto stream = both.open();  // the one after the other
  while (const auto block = stream->next())
    for (std::size_t row = 0; row < block->rows(); ++row, ++seen) {
      const bool of_first = seen < rows;
      imager::RowSight sight = block->sights[row];
      BOOST_TEST(table.antennas.at(static_cast<std::size_t>(sight.antenna_one)).diameter_m == (of_first ? 25.0 : 12.0));
      BOOST_TEST(table.antennas.at(static_cast<std::size_t>(sight.antenna_other)).diameter_m == (of_first ? 25.0 : 12.0));
      BOOST_TEST(table.pointings.at(static_cast<std::size_t>(sight.field)).set == (of_first ? first : second).path());
      if (of_first) continue;
      sight.antenna_one -= static_cast<int>(antennas);
      sight.antenna_other -= static_cast<int>(antennas);
      sight.field -= 2;
      BOOST_TEST(same(sight, alone.at(std::lround(block->uvw_m[3 * row]) - 1)));
    }
  BOOST_TEST(seen == 2 * rows);
}

BOOST_AUTO_TEST_CASE(shares_and_parts_have_the_numbers_of_the_whole) {
  const TwoPointings first;
  SimulatedObservation later = hourly();
  for (double& time_s : later.time_mjd_s) time_s += 86400;
  const TwoPointings second(later);
  const MeasurementSet whole(std::vector<std::string>{first.path(), second.path()}, with_sights(), "DATA");
  std::vector<imager::RowSight> expected, together;
  const auto append = [](const MeasurementSet& set, std::vector<imager::RowSight>& to) {
    const auto stream = set.open();
    while (const auto block = stream->next()) to.insert(to.end(), block->sights.begin(), block->sights.end());
  };
  append(whole, expected);
  for (int rank = 0; rank < 3; ++rank) {
    const OneOf ranks(rank, 3);
    const auto share = whole.share(ranks), part = share->part({1.0015e9, 1.0025e9});
    BOOST_TEST(share->sight_table().pointings.size() == 4U);
    BOOST_TEST(part->sight_table().antennas.size() == 2 * antennas);
    append(*part, together);
  }
  BOOST_REQUIRE_EQUAL(together.size(), expected.size());
  for (std::size_t row = 0; row < expected.size(); ++row) BOOST_TEST(same(together[row], expected[row]));
}

BOOST_AUTO_TEST_CASE(sights_are_told_where_they_are_asked_for) {
  const TwoPointings set;
  const MeasurementSet opened(set.path(), {}, "DATA");
  const auto stream = opened.open();
  while (const auto block = stream->next()) BOOST_TEST(block->sights.empty());
  BOOST_CHECK_THROW(opened.sight_table(), std::logic_error);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
