#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <stdexcept>

#include "imager/weighting/imaging_weights.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"
#include "tests/imager/thread_ranks.h"

BOOST_AUTO_TEST_SUITE(pointings)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;
constexpr std::size_t how_many = 5;
constexpr int without_samples = 3;
const ImageGeometry geometry{93, 110, cell_rad, {}};

const std::vector<WeightingOptions> every_way{
    {.weighting = Weighting::uniform, .pointings = how_many},
    {.weighting = Weighting::superuniform, .box_reach = 2, .pointings = how_many},
    {.weighting = Weighting::briggs, .robust = 0, .taper = taper_of_radii({20e3, 15e3, 0.4}), .pointings = how_many},
    {.weighting = Weighting::briggs_abs, .robust = -0.7, .noise_jy = 0.3, .pointings = how_many},
    {.weighting = Weighting::briggs_bandwidth_taper, .robust = 0.5, .fractional_bandwidth = 0.1, .pointings = how_many},
    {.weighting = Weighting::uniform,
     .rank_filter = RankFilter{2, 3},
     .window = {5e3, 40e3, 2e3, 10e3},
     .pointings = how_many}};

/// Blocks of one pointing and of several. Weights are small multiples of 1/8, whose sums are exact in any order.
std::vector<VisibilityBlock> some_blocks() {
  std::vector<VisibilityBlock> blocks;
  for (unsigned seed = 1; seed < 7; ++seed) {
    VisibilityBlock& block = blocks.emplace_back(random_samples(60 * seed, 4, cell_rad, seed, seed % 2 == 0 ? 1.1 : 0.3));
    for (float& weight : block.weight) weight = std::round(8 * weight) / 8;
    block.weight[seed] = 0;
    for (std::size_t row = 0; row < block.rows(); ++row) {
      const auto place = static_cast<int>((seed < 3 ? seed : row * row / 3) % (how_many - 1));
      block.sights.push_back({0, 1, place + (place >= without_samples ? 1 : 0), 0});
    }
  }
  return blocks;
}

/// The rows of a block that `wanted(row)`, without their sights.
template <typename Wanted>
VisibilityBlock rows_of(const VisibilityBlock& block, const Wanted& wanted) {
  VisibilityBlock part;
  part.frequency_hz = block.frequency_hz;
  const std::size_t channels = block.channels();
  for (std::size_t row = 0; row < block.rows(); ++row) {
    if (!wanted(row)) continue;
    part.uvw_m.append(&block.uvw_m[3 * row], &block.uvw_m[3 * row] + 3);
    for (std::size_t i = row * channels; i < (row + 1) * channels; ++i) {
      part.visibility.push_back(block.visibility[i]);
      part.weight.push_back(block.weight[i]);
    }
  }
  return part;
}

std::vector<VisibilityBlock> of_pointing(const std::vector<VisibilityBlock>& blocks, int pointing) {
  std::vector<VisibilityBlock> parts;
  for (const VisibilityBlock& block : blocks)
    parts.push_back(rows_of(block, [&](std::size_t row) { return block.sights[row].field == pointing; }));
  return parts;
}

/// The same rows, in blocks of at most `most`.
std::vector<VisibilityBlock> cut(const std::vector<VisibilityBlock>& blocks, std::size_t most) {
  std::vector<VisibilityBlock> parts;
  for (const VisibilityBlock& block : blocks)
    for (std::size_t first = 0; first < block.rows(); first += most) {
      const std::size_t end = std::min(first + most, block.rows());
      parts.push_back(rows_of(block, [&](std::size_t row) { return row >= first && row < end; }));
      parts.back().sights.assign(block.sights.begin() + static_cast<std::ptrdiff_t>(first),
                                 block.sights.begin() + static_cast<std::ptrdiff_t>(end));
    }
  return parts;
}

std::shared_ptr<const ImagingWeights> weights_of(const std::vector<VisibilityBlock>& blocks, const WeightingOptions& options,
                                                 int threads) {
  return make_imaging_weights(stored(blocks), options, geometry, {threads});
}

/// The weights of all samples, one block after the other.
std::vector<float> put_on(const ImagingWeights& weights, const std::vector<VisibilityBlock>& blocks) {
  std::vector<float> all;
  for (const VisibilityBlock& block : blocks) {
    const auto made = weights.of(std::make_shared<VisibilityBlock>(block)).block;
    all.insert(all.end(), made->weight.begin(), made->weight.end());
  }
  return all;
}

}  // namespace

BOOST_DATA_TEST_CASE(each_pointing_has_the_weights_of_its_samples_alone, bdata::xrange(every_way.size()) * bdata::make({1, 3}),
                     way, threads) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const auto together = weights_of(blocks, every_way[way], threads);
  WeightingOptions shared = every_way[way];
  shared.pointings = 1;
  std::uint64_t filled = 0;
  std::vector<double> f2;
  std::map<int, std::vector<float>> alone;
  for (int p = 0; p < static_cast<int>(how_many); ++p) {
    const std::vector<VisibilityBlock> own = of_pointing(blocks, p);
    const auto weights = weights_of(own, shared, 1);
    filled += weights->cells_filled();
    if (p != without_samples) f2.push_back(weights->f2().least);
    alone[p] = put_on(*weights, own);
  }
  std::map<int, std::vector<float>> made;
  for (const VisibilityBlock& block : blocks) {
    const std::vector<float> weight = put_on(*together, {block});
    for (std::size_t i = 0; i < weight.size(); ++i) made[block.sights[i / block.channels()].field].push_back(weight[i]);
  }
  for (const auto& [pointing, weight] : made) BOOST_CHECK(weight == alone[pointing]);
  BOOST_TEST(made.size() == how_many - 1);
  BOOST_TEST(together->pointings() == how_many);
  BOOST_TEST(together->cells_filled() == filled);
  BOOST_TEST(together->f2().least == *std::min_element(f2.begin(), f2.end()));
  BOOST_TEST(together->f2().largest == *std::max_element(f2.begin(), f2.end()));
  BOOST_CHECK(put_on(*weights_of(blocks, shared, 1), blocks) != put_on(*together, blocks));
}

BOOST_DATA_TEST_CASE(threads_and_blocks_leave_every_bit, bdata::xrange(every_way.size()), way) {
  std::vector<VisibilityBlock> blocks = some_blocks();
  for (VisibilityBlock& block : blocks)
    for (float& weight : block.weight) weight *= 1.1F;  // sums are not exact any more
  const std::vector<float> expected = put_on(*weights_of(blocks, every_way[way], 1), blocks);
  for (const std::size_t rows : {7, 50})
    BOOST_CHECK(put_on(*weights_of(cut(blocks, rows), every_way[way], 3), blocks) == expected);
}

BOOST_DATA_TEST_CASE(ranks_add_up_the_density_of_each_pointing, bdata::xrange(every_way.size()) * bdata::make({2, 3}), way,
                     size) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const std::vector<float> expected = put_on(*weights_of(blocks, every_way[way], 1), blocks);
  ThreadRanks(size).run([&](const Ranks& ranks) {
    const RankShare own(blocks, ranks);
    const auto weights = make_imaging_weights(own, every_way[way], geometry, {1});
    if (put_on(*weights, blocks) != expected) throw std::runtime_error("weights differ from those of one rank");
  });
}

BOOST_AUTO_TEST_CASE(samples_that_share_a_density_need_no_sights) {
  std::vector<VisibilityBlock> blocks = some_blocks();
  WeightingOptions options = every_way[2];
  options.pointings = 1;
  const std::vector<float> with_sights = put_on(*weights_of(blocks, options, 1), blocks);
  for (VisibilityBlock& block : blocks) block.sights.clear();
  BOOST_CHECK(put_on(*weights_of(blocks, options, 1), blocks) == with_sights);
}

BOOST_AUTO_TEST_CASE(rows_that_do_not_tell_their_pointing_are_refused) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const auto weights = weights_of(blocks, every_way[0], 1);
  const auto says = [](const std::string& words) {
    return [words](const std::invalid_argument& error) { return std::string(error.what()) == words; };
  };
  const auto refused = [&](const VisibilityBlock& wrong, const std::string& words) {
    BOOST_CHECK_EXCEPTION(weights_of({wrong}, every_way[0], 1), std::invalid_argument, says(words));
    BOOST_CHECK_EXCEPTION(put_on(*weights, {wrong}), std::invalid_argument, says(words));
  };
  VisibilityBlock block = blocks.front();
  block.sights.clear();
  refused(block, "0 sights of 60 rows; expected one for each, that tells its pointing");
  for (const int wrong : {-1, static_cast<int>(how_many)}) {
    block = blocks.front();
    block.sights[7].field = wrong;
    refused(block, "a row of pointing " + std::to_string(wrong) + "; expected one from 0 to 4");
  }
}

BOOST_AUTO_TEST_SUITE_END()
