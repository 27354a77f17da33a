#include "imager/coplanar/tile_order.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <set>

#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(tile_order)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using misfit::imager::testing::random_samples;

namespace {

constexpr double cell_rad = 1e-5;

ImageGeometry image() {
  ImageGeometry geometry;
  geometry.cell_rad = cell_rad;
  return geometry;
}

/// Some samples of weight 0, some beyond the grid.
VisibilityBlock samples(std::size_t channels = 17) {
  VisibilityBlock block = random_samples(5100 / channels, channels, cell_rad, 1, 1.3);
  for (std::size_t i = 0; i < block.samples(); i += 7) block.weight[i] = 0;
  return block;
}

GridShape shape_of(int kernel_width) {
  return {90, 64, kernel_width, 16};
}

struct Turns {
  double u, v;
};

/// Position in turns per cell of the image: u · cell and v · cell.
Turns turns(const VisibilityBlock& block, std::size_t sample) {
  const std::size_t row = sample / block.channels();
  const double per_m = block.frequency_hz[sample % block.channels()] / speed_of_light_m_s * cell_rad;
  return {block.uvw_m[3 * row] * per_m, block.uvw_m[3 * row + 1] * per_m};
}

/// The tile of the first of the W cells nearest to a sample, once it is brought into the half plane v ≥ 0 of one period.
std::size_t expected_tile(Turns at, const GridShape& s) {
  at.u -= std::round(at.u);
  at.v -= std::round(at.v);
  const double sign = at.v < 0 ? -1 : 1;
  const double p = -sign * at.u * s.nu, q = sign * at.v * s.nv;
  const auto first = [&](double cells) { return static_cast<int>(std::ceil(cells - s.width / 2.0)); };
  const int tile = s.first_row(first(q)) / s.tile * s.tiles_u() + s.first_column(first(p)) / s.tile;
  return static_cast<std::size_t>(tile);
}

/// Visits (tile, sample) in order.
template <typename Visit>
void for_each_sample(const TileOrder& order, std::size_t channels, const Visit& visit) {
  for (std::size_t tile = 0; tile + 1 < order.begin.size(); ++tile)
    for (std::size_t r = order.begin[tile]; r < order.begin[tile + 1]; ++r)
      for (std::size_t k = 0; k < order.run[r].count; ++k) visit(tile, order.run[r].row * channels + order.run[r].first + k);
}

bool wants(Wanted wanted, const VisibilityBlock& block, std::size_t sample) {
  const auto [u, v] = turns(block, sample);
  if (wanted == Wanted::all) return true;
  if (wanted == Wanted::usable || wanted == Wanted::imaging_beyond) return block.weight[sample] != 0;
  return block.weight[sample] != 0 && std::abs(u) <= 0.5 && std::abs(v) <= 0.5;
}

}  // namespace

BOOST_DATA_TEST_CASE(every_wanted_sample_occurs_once_in_the_tile_of_its_first_tap,
                     bdata::make({0, 1, 2, 3}) * bdata::make({1, 2, 7, 8, 16}) * bdata::make({1, 17}), kind, kernel_width,
                     channels) {
  const auto wanted = static_cast<Wanted>(kind);
  const GridShape shape = shape_of(kernel_width);
  const VisibilityBlock block = samples(static_cast<std::size_t>(channels));
  const TileOrder order = order_by_tile(block, {block, 1}, shape, image(), wanted, 2);
  std::vector<int> seen(block.samples());
  std::vector<std::size_t> in_tile(order.samples.size());
  std::size_t wrong_tile = 0;
  for_each_sample(order, block.channels(), [&](std::size_t tile, std::size_t sample) {
    ++seen[sample];
    ++in_tile[tile];
    if (tile != expected_tile(turns(block, sample), shape)) ++wrong_tile;
  });
  std::size_t wrong_count = 0;
  for (std::size_t i = 0; i < block.samples(); ++i)
    if (seen[i] != (wants(wanted, block, i) ? 1 : 0)) ++wrong_count;
  BOOST_TEST(wrong_tile == 0U);
  BOOST_TEST(wrong_count == 0U);
  BOOST_TEST(in_tile == order.samples, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(runs_are_as_long_as_they_can_be_and_follow_the_rows) {
  const VisibilityBlock block = samples();
  const TileOrder order = order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, 2);
  for (std::size_t tile = 0; tile + 1 < order.begin.size(); ++tile)
    for (std::size_t r = order.begin[tile]; r + 1 < order.begin[tile + 1]; ++r) {
      const SampleRun a = order.run[r], b = order.run[r + 1];
      BOOST_TEST((a.row < b.row || (a.row == b.row && a.first + a.count < b.first)));
    }
}

BOOST_AUTO_TEST_CASE(rows_of_one_channel_make_runs_within_a_tile_which_longer_ones_would_leave) {
  VisibilityBlock block = random_samples(10000, 1, cell_rad, 3, 1.3);
  std::vector<double>& uvw_m = block.uvw_m.edit();
  const auto at = [&](std::size_t i) { return std::vector<double>{uvw_m[3 * i], uvw_m[3 * i + 1], 0}; };
  std::vector<std::vector<double>> places;
  for (std::size_t i = 0; i < block.rows(); ++i) places.push_back(at(i));
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  for (std::size_t i = 0; i < places.size(); ++i) std::copy(places[i].begin(), places[i].end(), &uvw_m[3 * i]);
  const GridShape shape = shape_of(6);
  const TileOrder order = order_by_tile(block, {block, 1}, shape, image(), Wanted::usable, 2);
  std::vector<std::size_t> tile_of(block.rows());
  for_each_sample(order, 1, [&](std::size_t tile, std::size_t sample) { tile_of[sample] = tile; });
  std::size_t longest = 0, needless = 0;
  for (const SampleRun& run : order.run) {
    longest = std::max<std::size_t>(longest, run.count);
    const std::size_t end = run.row + run.count;
    const auto inside = [&](std::size_t row) { return wants(Wanted::imaging, block, row); };
    const bool of_a_chunk = (end * 32 + 31) % block.rows() < 32;  // rows are looked through in 32 parts
    if (end < block.rows() && tile_of[end] == tile_of[run.row] && inside(run.row) && inside(end) && !of_a_chunk) ++needless;
  }
  BOOST_TEST(longest > 3U);
  BOOST_TEST(needless == 0U);
}

BOOST_AUTO_TEST_CASE(a_run_of_more_channels_than_its_counter_holds_is_split) {
  VisibilityBlock block = random_samples(1, 10000, cell_rad, 2, 0);
  std::fill(block.frequency_hz.begin(), block.frequency_hz.end(), 1e9);
  const TileOrder order = order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, 1);
  std::set<std::size_t> seen;
  for_each_sample(order, block.channels(), [&](std::size_t, std::size_t sample) { seen.insert(sample); });
  BOOST_TEST(seen.size() == 10000U);
  BOOST_TEST(order.run.size() == 3U);
}

BOOST_AUTO_TEST_CASE(sums_are_of_the_samples_in_the_order_and_those_outside_are_counted) {
  const VisibilityBlock block = samples();
  const TileOrder order = order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, 2);
  std::uint64_t used = 0, outside = 0;
  double weight = 0, weight_abs = 0, weight_square = 0, weight2_square = 0;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    if (block.weight[i] == 0) continue;
    if (!wants(Wanted::imaging, block, i)) {
      ++outside;
      continue;
    }
    const double w = double{block.weight[i]}, size = std::abs(std::complex<double>(block.visibility[i]));
    ++used;
    weight += w;
    weight_abs += w * size;
    weight_square += w * size * size;
    weight2_square += w * w * size * size;
  }
  BOOST_TEST(order.sums[0].used == used);
  BOOST_TEST(order.sums[0].outside_grid == outside);
  BOOST_TEST(outside > 0U);
  // Some thousand additions of positive terms: 1e-12 is their rounding.
  const auto close = boost::test_tools::tolerance(1e-12);
  BOOST_TEST(order.sums[0].weight == weight, close);
  BOOST_TEST(order.sums[0].weight_abs == weight_abs, close);
  BOOST_TEST(order.sums[0].weight_square == weight_square, close);
  BOOST_TEST(order.sums[0].weight2_square == weight2_square, close);
}

BOOST_AUTO_TEST_CASE(sums_are_of_the_visibilities_given_in_place_of_the_blocks_own) {
  const VisibilityBlock block = samples();
  const std::vector<std::complex<double>> other(block.samples(), 2);
  const SampleSums sums = order_by_tile(block, {other.data()}, shape_of(6), image(), Wanted::imaging, 2).sums[0];
  BOOST_TEST(sums.weight_abs == 2 * sums.weight, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(sums_leave_out_what_has_no_weight_even_where_it_is_not_a_number) {
  VisibilityBlock block = samples();
  const SampleSums should = order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, 2).sums[0];
  for (std::size_t i = 0; i < block.samples(); ++i)
    if (block.weight[i] == 0) block.visibility[i] = std::numeric_limits<float>::quiet_NaN();
  const SampleSums sums = order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, 2).sums[0];
  BOOST_TEST(sums.weight_abs == should.weight_abs);
  BOOST_TEST(sums.weight2_square == should.weight2_square);
}

BOOST_AUTO_TEST_CASE(order_and_sums_do_not_depend_on_the_number_of_threads) {
  const VisibilityBlock block = samples();
  const auto order = [&](int threads) {
    return order_by_tile(block, {block, 1}, shape_of(6), image(), Wanted::imaging, threads);
  };
  const TileOrder one = order(1);
  for (const int threads : {2, 3, 40}) {
    const TileOrder many = order(threads);
    BOOST_TEST((many.begin == one.begin));
    std::vector<std::size_t> first, second;
    for_each_sample(one, block.channels(), [&](std::size_t, std::size_t sample) { first.push_back(sample); });
    for_each_sample(many, block.channels(), [&](std::size_t, std::size_t sample) { second.push_back(sample); });
    BOOST_TEST((first == second));
    BOOST_TEST(many.sums[0].weight_abs == one.sums[0].weight_abs);
  }
}

BOOST_AUTO_TEST_CASE(more_channels_than_a_run_can_name_are_refused) {
  VisibilityBlock block;
  block.frequency_hz.resize((1U << 20) + 1);
  BOOST_CHECK_THROW(order_by_tile(block, {}, shape_of(6), image(), Wanted::all, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
