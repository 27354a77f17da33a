// What each of several ranks reads of a selection.
#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <numeric>
#include <tuple>

#include "tests/ms_io/one_of.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(row_shares)

namespace bdata = boost::unit_test::data;
using namespace testing;

namespace {

/// u, frequency and visibility of a sample, by which small sets tell all of them apart.
using Sample = std::tuple<double, double, float, float>;

std::vector<Sample> samples_of(const MeasurementSet& set) {
  std::vector<Sample> all;
  const auto stream = set.open();
  while (const auto block = stream->next())
    for (std::size_t row = 0; row < block->rows(); ++row)
      for (std::size_t c = 0; c < block->channels(); ++c) {
        const std::complex<float> v = block->visibility[row * block->channels() + c];
        all.emplace_back(block->uvw_m[3 * row], block->frequency_hz[c], v.real(), v.imag());
      }
  std::sort(all.begin(), all.end());
  return all;
}

void check_shares(const MeasurementSet& whole, int size) {
  std::vector<Sample> together;
  std::vector<std::uint64_t> counted;
  for (int rank = 0; rank < size; ++rank) {
    const OneOf ranks(rank, size);
    const auto share = whole.share(ranks);
    const std::vector<Sample> mine = samples_of(*share);
    BOOST_TEST(share->samples() == mine.size());
    BOOST_TEST(share->sharing().samples[static_cast<std::size_t>(rank)] == mine.size());
    BOOST_TEST(share->observation().frequency_hz == whole.observation().frequency_hz);
    together.insert(together.end(), mine.begin(), mine.end());
    counted.push_back(mine.size());
  }
  std::sort(together.begin(), together.end());
  BOOST_TEST((together == samples_of(whole)));
  // A cut lies before a row, and the row that holds it has as many samples as there are channels.
  const auto [least, most] = std::minmax_element(counted.begin(), counted.end());
  BOOST_TEST(*most - *least <= 2 * channels);
}

}  // namespace

BOOST_DATA_TEST_CASE(shares_hold_every_sample_once_and_about_as_many_each, bdata::make({1, 2, 3, 4, 7, 8, 40}), size) {
  const SmallSet set;
  set.add_spectral_window();
  for (const char* spw : {"", "0", "1:1~3"}) check_shares(MeasurementSet(set.path(), {"", spw}, "DATA"), size);
  check_shares(MeasurementSet(set.path(), {}, "DATA", {imager::Stokes::I}, 10), size);
}

BOOST_AUTO_TEST_CASE(sets_that_can_be_are_shared_whole) {
  const SmallSet first, second, third;
  const std::vector<std::string> paths{first.path(), second.path(), third.path()};
  const MeasurementSet sets(paths, {}, "DATA");
  for (const auto& [size, whole] : {std::pair(1, true), {3, true}, {2, false}, {4, false}}) {
    const OneOf ranks(0, size);
    BOOST_TEST(sets.share(ranks)->sharing().whole_sets == whole);
    BOOST_TEST(sets.share(ranks)->sharing().sets == 3U);
    check_shares(sets, size);
  }
}

/// What the antennas of one rank's rows are is told by numbers that mean the same on all.
BOOST_AUTO_TEST_CASE(sorts_of_antennas_are_numbered_alike) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& changed) {
    casacore::ScalarColumn<double> diameter(changed.antenna(), "DISH_DIAMETER");
    for (std::size_t a = 0; a < antennas; ++a) diameter.put(a, a < 2 ? 25.0 : 12.0);
  });
  const MeasurementSet whole(set.path(), {}, "DATA");
  const BeamRows all = whole.beam_rows();
  std::vector<std::pair<int, int>> expected, together;
  for (const SortPair& pair : all.pairs) expected.emplace_back(pair.one, pair.other);
  for (int rank = 0; rank < 4; ++rank) {
    const OneOf ranks(rank, 4);
    const BeamRows mine = whole.share(ranks)->beam_rows();
    BOOST_REQUIRE_EQUAL(mine.sorts.size(), 2U);
    BOOST_TEST(mine.sorts[0].diameter_m == all.sorts[0].diameter_m);
    for (const SortPair& pair : mine.pairs) together.emplace_back(pair.one, pair.other);
  }
  BOOST_TEST((together == expected));  // blocks, and so shares, are in the order of the table
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
