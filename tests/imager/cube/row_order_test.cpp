#include "imager/cube/row_order.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

BOOST_AUTO_TEST_SUITE(row_order)

using namespace misfit::imager;

BOOST_AUTO_TEST_CASE(each_row_of_a_lattice_lies_beside_the_one_before) {
  constexpr int side = 64;
  std::vector<double> uvw_m;
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {  // the middles of cells of the square [-1, 1] x [0, 2], half of them mirrored
      const double sign = (u + v) % 2 == 0 ? 1 : -1;
      uvw_m.insert(uvw_m.end(), {sign * ((2 * u + 1.0) / side - 1), sign * (v + 0.5) / side, 7.0});
    }
  uvw_m.insert(uvw_m.end(), {1, 0, 0, 0, 1, 0});  // the square's corners, so that it is known
  std::vector<std::uint32_t> order = order_in_uv(uvw_m);
  order.erase(std::remove_if(order.begin(), order.end(), [](std::uint32_t row) { return row >= side * side; }), order.end());
  BOOST_TEST_REQUIRE(order.size() == std::size_t{side} * side);
  int far = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const int du = static_cast<int>(order[i] % side) - static_cast<int>(order[i - 1] % side);
    const int dv = static_cast<int>(order[i] / side) - static_cast<int>(order[i - 1] / side);
    far += std::abs(du) + std::abs(dv) != 1;
  }
  BOOST_TEST(far == 0);
}

BOOST_AUTO_TEST_CASE(every_row_comes_once_those_of_one_place_as_given_and_those_of_none_first) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<double> uvw_m;
  for (int i = 0; i < 300; ++i) {
    const double u = place(random), v = place(random);
    for (int again = 0; again < 2; ++again) uvw_m.insert(uvw_m.end(), {u, v, place(random)});
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  uvw_m.insert(uvw_m.end(), {nan, 0, 0, 0, -nan, 0});
  const std::vector<std::uint32_t> order = order_in_uv(uvw_m);
  std::vector<std::uint32_t> sorted = order, all(uvw_m.size() / 3);
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0U);
  BOOST_TEST(sorted == all, boost::test_tools::per_element());
  BOOST_TEST(order[0] == 600U);
  BOOST_TEST(order[1] == 601U);
  std::vector<std::size_t> at(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) at[order[i]] = i;
  for (std::size_t row = 0; row < 600; row += 2) BOOST_TEST(at[row] < at[row + 1]);
}

BOOST_AUTO_TEST_CASE(no_rows_and_rows_of_zeros_have_an_order_too) {
  BOOST_TEST(order_in_uv({}).empty());
  BOOST_TEST(order_in_uv({0, 0, 0, 0, 0, 0}) == (std::vector<std::uint32_t>{0, 1}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
