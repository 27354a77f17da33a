#include "imager/streaming/uv_coverage.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(uv_coverage)

using namespace misfit::imager;
using misfit::imager::testing::random_samples;

namespace {

constexpr double cell_rad = 1e-4;
constexpr double reach_lambda = 1 / (2 * cell_rad);
constexpr int side = UvCoverage::side;

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::vector<std::uint64_t> counts_of(const VisibilityBlock& block, double reach = reach_lambda) {
  UvCoverage coverage(reach);
  coverage.add(block);
  return coverage.counts();
}

/// A sample of weight 1 at every channel of one row.
VisibilityBlock one_row(double u_m, double v_m, const std::vector<double>& frequency_hz) {
  VisibilityBlock block;
  block.uvw_m = {u_m, v_m, 0};
  block.frequency_hz = frequency_hz;
  block.visibility.assign(frequency_hz.size(), 1);
  block.weight.assign(frequency_hz.size(), 1);
  return block;
}

/// A thousand channels a ten-thousandth apart, some sixty to a cell.
std::vector<double> narrow_channels() {
  std::vector<double> frequency_hz;
  for (int channel = 0; channel < 1000; ++channel) frequency_hz.push_back(1e9 * (1 + 1e-4 * channel));
  return frequency_hz;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_usable_sample_and_its_mirror_image_count_once) {
  VisibilityBlock block = random_samples(200, 40, cell_rad, 1);
  std::uint64_t usable = block.samples();
  for (std::size_t i = 0; i < block.samples(); i += 3, --usable) block.weight[i] = 0;
  BOOST_TEST(total(counts_of(block)) == 2 * usable);
}

BOOST_AUTO_TEST_CASE(a_sample_lies_where_its_uv_does_and_its_mirror_image_opposite) {
  const double metres_a_cell = 2 * reach_lambda / side * speed_of_light_m_s / 1e9;
  const auto counts = counts_of(one_row(20.5 * metres_a_cell, -50.5 * metres_a_cell, {1e9}));
  BOOST_TEST(total(counts) == 2U);
  BOOST_TEST(counts[(side / 2 - 51) * side + side / 2 + 20] == 1U);
  BOOST_TEST(counts[(side / 2 + 50) * side + side / 2 - 21] == 1U);
}

BOOST_AUTO_TEST_CASE(a_band_leaves_a_streak_without_gaps_whichever_way_its_channels_run) {
  std::vector<double> frequency_hz = narrow_channels();
  const double lowest = frequency_hz.front(), highest = frequency_hz.back();
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(frequency_hz.begin(), frequency_hz.end());
    // u of the highest channel is the reach; the lowest lies 15 cells from there.
    const auto counts = counts_of(one_row(reach_lambda * speed_of_light_m_s / highest, 0, frequency_hz));
    const int first = static_cast<int>(side / 2.0 * (1 + lowest / highest));
    for (int u = first + 1; u < side; ++u) BOOST_TEST(counts[side / 2 * side + u] > 0U, u);
    for (int u = side / 2; u < first; ++u) BOOST_TEST(counts[side / 2 * side + u] == 0U, u);
    BOOST_TEST(total(counts) == 2 * frequency_hz.size());
  }
}

BOOST_AUTO_TEST_CASE(what_lies_beyond_the_reach_or_nowhere_is_not_counted) {
  const double edge_m = reach_lambda * speed_of_light_m_s / 1e9;
  for (const double u_m :
       {1.001 * edge_m, -1.001 * edge_m, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(total(counts_of(one_row(u_m, 0, {1e9}))) == 0U);
    BOOST_TEST(total(counts_of(one_row(0, u_m, {1e9}))) == 0U);
  }
  BOOST_TEST(total(counts_of(one_row(edge_m, -edge_m, {1e9}))) == 2U);
}

BOOST_AUTO_TEST_CASE(without_a_reach_nothing_is_counted) {
  BOOST_TEST(counts_of(random_samples(20, 4, cell_rad, 1), 0).empty());
}

BOOST_AUTO_TEST_SUITE_END()
