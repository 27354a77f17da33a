#include "imager/plane/tile_positions.h"

#include <hwy/targets.h>

#include <boost/mpl/list.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

using namespace misfit::imager;

namespace {

using Precisions = boost::mpl::list<float, double>;

constexpr RowInTile row{2e-9, 1000, 3e-9, 1500, 16};

}  // namespace

BOOST_AUTO_TEST_SUITE(tile_positions)

BOOST_AUTO_TEST_CASE_TEMPLATE(positions_are_whole_cells_and_what_is_left_with_every_instruction_set, Real, Precisions) {
  constexpr int count = 37;
  double frequency_hz[count];
  for (int i = 0; i < count; ++i) frequency_hz[i] = 5.0003e11 + 1.4e8 * i;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    TilePlaces<Real> batch;
    for (const int some : {5, 0, 32}) append_positions(row, frequency_hz + batch.count, some, batch);
    BOOST_TEST_REQUIRE(batch.count == count);
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      const double u = row.u_per_hz * frequency_hz[i] - row.u_origin, v = row.v_per_hz * frequency_hz[i] - row.v_origin;
      BOOST_TEST(batch.column[i] == std::floor(u));
      BOOST_TEST(batch.row[i] == std::floor(v));
      largest = std::max(
          {largest, std::abs(batch.tu[i] - (u - std::floor(u) - 0.5)), std::abs(batch.tv[i] - (v - std::floor(v) - 0.5))});
    }
    // t is rounded once to Real, and positions of some 1500 cells to double.
    BOOST_TEST(largest <= 0.5 * double{std::numeric_limits<Real>::epsilon()} + 1e-12);
  }
  hwy::SetSupportedTargetsForTest(0);
}

BOOST_AUTO_TEST_CASE(positions_that_rounding_takes_out_of_the_tile_stay_within) {
  const double frequency_hz[] = {1, 2};
  TilePlaces<double> batch;
  append_positions({1, 1 + 1e-12, 8, 0, 16}, frequency_hz, 2, batch);
  BOOST_TEST(batch.column[0] == 0);
  BOOST_TEST(batch.row[1] == 15);
  BOOST_TEST(batch.tv[1] == 0.5);
}

BOOST_AUTO_TEST_SUITE_END()
