#include "imager/streaming/weight_shares.h"

#include <boost/test/unit_test.hpp>
#include <map>

#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(weight_shares)

using namespace misfit::imager;
using namespace misfit::imager::testing;

BOOST_AUTO_TEST_CASE(weights_add_up_by_kind_and_frequency_over_all_blocks_without_what_lies_outside) {
  constexpr double cell_rad = 1e-4;
  // At the lowest frequency all rows of the second block lie within the grid, at the highest not.
  std::vector<VisibilityBlock> blocks{random_samples(50, 3, cell_rad, 1), random_samples(30, 2, cell_rad, 2, 1.1)};
  blocks[0].weight[7] = 0;
  const auto kind_of = [](std::uint64_t row) { return static_cast<std::uint32_t>(row % 3 == 0 ? 5 : 2); };
  std::map<std::pair<std::uint32_t, double>, double> expected;
  std::uint64_t row_of_all = 0, outside = 0;
  for (const VisibilityBlock& block : blocks)
    for (std::size_t row = 0; row < block.rows(); ++row, ++row_of_all)
      for (std::size_t c = 0; c < block.channels(); ++c) {
        const double turns_a_metre = block.frequency_hz[c] / speed_of_light_m_s * cell_rad;
        if (std::abs(block.uvw_m[3 * row] * turns_a_metre) > 0.5 || std::abs(block.uvw_m[3 * row + 1] * turns_a_metre) > 0.5)
          ++outside;
        else
          expected[{kind_of(row_of_all), block.frequency_hz[c]}] += block.weight[row * block.channels() + c];
      }
  BOOST_TEST(outside > 0U);
  for (const int threads : {1, 3}) {
    const auto shares = misfit::imager::weight_shares(stored(blocks), {cell_rad, kind_of, threads});
    BOOST_REQUIRE_EQUAL(shares.size(), expected.size());
    auto next = expected.begin();
    for (const WeightShare& share : shares) {
      BOOST_TEST(share.kind == next->first.first);
      BOOST_TEST(share.frequency_hz == next->first.second);
      BOOST_TEST(share.weight == (next++)->second);  // sums of few floats in double precision are exact
    }
  }
  BOOST_TEST(misfit::imager::weight_shares(stored(blocks), {cell_rad, {}, 1}).size() ==
             4U);  // frequencies; they share the lowest
}

BOOST_AUTO_TEST_SUITE_END()
