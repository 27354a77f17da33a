#include "imager/coplanar/tile_positions.h"

#include <hwy/targets.h>

#include <boost/mpl/list.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <vector>

BOOST_AUTO_TEST_SUITE(tile_positions)

using namespace misfit::imager;

namespace {

using Precisions = boost::mpl::list<float, double>;

constexpr RowInTile row{2e-9, 1000, 3e-9, 1500, 16};

}  // namespace

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

BOOST_AUTO_TEST_CASE_TEMPLATE(rows_of_one_channel_are_placed_to_the_bits_of_one_by_one, Real, Precisions) {
  constexpr int count = 37;
  const RowsInTile rows{-2.1e-9, 3.3e-9, 1.1e9, -20.5, 90.25, 16};
  std::vector<double> uvw_m;
  for (int i = 0; i < count; ++i) {  // across the tile, every third in the other half of the plane
    const double sign = i % 3 == 0 ? -1 : 1;
    uvw_m.insert(uvw_m.end(), {sign * (8.8 - 0.19 * i), sign * (24.9 + 0.119 * i), 7});
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    TilePlaces<Real> together, alone;
    bool negated[count];
    for (const int some : {5, 0, 32})
      append_rows(rows, &uvw_m[3 * static_cast<std::size_t>(together.count)], some, together, negated + together.count);
    BOOST_TEST_REQUIRE(together.count == count);
    for (int i = 0; i < count; ++i) {
      const double sign = i % 3 == 0 ? -1 : 1;
      const double* const at = &uvw_m[3 * static_cast<std::size_t>(i)];
      append_position(
          {sign * at[0] * rows.u_cells_per_m_hz, rows.u_origin, sign * at[1] * rows.v_cells_per_m_hz, rows.v_origin, 16},
          rows.frequency_hz, alone);
      BOOST_TEST(negated[i] == (i % 3 == 0));
      BOOST_TEST(together.column[i] == alone.column[i]);
      BOOST_TEST(together.row[i] == alone.row[i]);
      BOOST_TEST(together.tu[i] == alone.tu[i]);
      BOOST_TEST(together.tv[i] == alone.tv[i]);
    }
    BOOST_TEST(together.column[0] != together.column[count - 1]);
    BOOST_TEST(together.row[0] != together.row[count - 1]);
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
