#include "imager/weighting/imaging_weights.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/beams/beam.h"
#include "imager/data/noise.h"
#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"
#include "imager/streaming/streamed_visibilities.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"
#include "tests/imager/weighting/plain_density.h"

BOOST_AUTO_TEST_SUITE(imaging_weights)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;
const ImageGeometry geometry{64, 48, cell_rad, {}};
const UvTaper taper = taper_of_radii({20e3, 15e3, 0.4});
const UvWindow window{5e3, 40e3, 2e3, 10e3};

const std::vector<WeightingOptions> every_way{
    {.weighting = Weighting::uniform},
    {.weighting = Weighting::superuniform, .box_reach = 2},
    {.weighting = Weighting::briggs, .robust = 0},
    {.weighting = Weighting::briggs, .robust = -0.5, .taper = taper},
    {.weighting = Weighting::natural, .taper = taper},
    {.weighting = Weighting::uniform, .rank_filter = RankFilter{2, 3}, .window = window}};

std::vector<VisibilityBlock> some_blocks() {
  std::vector<VisibilityBlock> blocks;
  for (unsigned seed = 1; seed < 5; ++seed) {
    blocks.push_back(random_samples_with_w(100 * seed, 3, cell_rad, 50, seed, 1.1));
    blocks.back().weight[seed] = 0;
    blocks.back().counts.used = blocks.back().counts.samples_read = blocks.back().samples();
  }
  return blocks;
}

std::shared_ptr<const ImagingWeights> weights_of(const VisibilitySource& source, const WeightingOptions& options, int threads) {
  return make_imaging_weights(source, options, geometry, {threads});
}

std::shared_ptr<const VisibilityBlock> weighted(const ImagingWeights& weights, const VisibilityBlock& block) {
  return weights.of(std::make_shared<VisibilityBlock>(block)).block;
}

std::vector<float> weights_of_a_pass(const VisibilitySource& source) {
  std::vector<float> weights;
  const auto stream = source.open();
  while (const auto block = stream->next()) weights.insert(weights.end(), block->weight.begin(), block->weight.end());
  return weights;
}

/// What the taper of `every_way` is by its definition.
double plain_taper(double u, double v) {
  const double along = u * std::sin(0.4) + v * std::cos(0.4), across = -u * std::cos(0.4) + v * std::sin(0.4);
  return std::exp(-std::log(2) * (std::pow(along / 20e3, 2) + std::pow(across / 15e3, 2)));
}

/// Samples on a lattice that fills the uv plane evenly.
VisibilityBlock even_samples() {
  constexpr int side = 96;
  VisibilityBlock block;
  block.frequency_hz = {speed_of_light_m_s};
  for (int row = -side / 2; row < side / 2; ++row)
    for (int column = -side / 2; column < side / 2; ++column)
      for (const double x : {(column + 0.5) / (side * cell_rad), (row + 0.5) / (side * cell_rad), 0.0})
        block.uvw_m.edit().push_back(x);
  block.visibility.assign(block.rows(), 1);
  block.weight.assign(block.rows(), 1);
  return block;
}

}  // namespace

BOOST_AUTO_TEST_CASE(natural_weights_without_a_taper_are_those_of_the_data) {
  BOOST_TEST(weights_of(stored(some_blocks()), {}, 1) == nullptr);
}

BOOST_AUTO_TEST_CASE(weights_are_their_formulas_times_the_taper) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const PlainDensity plain(geometry, blocks);
  const auto uniform = weights_of(stored(blocks), every_way[0], 1), briggs = weights_of(stored(blocks), every_way[3], 1),
             natural = weights_of(stored(blocks), every_way[4], 1);
  for (const VisibilityBlock& block : blocks) {
    const auto by_uniform = weighted(*uniform, block), by_briggs = weighted(*briggs, block),
               by_taper = weighted(*natural, block);
    plain.for_each(block, [&](std::size_t row, std::size_t channel, const PlainDensity::Cell& cell, std::uint32_t) {
      const std::size_t i = row * block.channels() + channel;
      const double w{block.weight[i]}, per_m = block.frequency_hz[channel] / speed_of_light_m_s;
      const double tapered = plain_taper(block.uvw_m[3 * row] * per_m, block.uvw_m[3 * row + 1] * per_m);
      // Two roundings to single precision.
      BOOST_TEST(std::abs(by_uniform->weight[i] / (w / plain.at(cell)) - 1) < 2e-7);
      BOOST_TEST(std::abs(by_briggs->weight[i] / (w / (1 + plain.at(cell) * briggs->f2().least) * tapered) - 1) < 2e-7);
      BOOST_TEST(std::abs(by_taper->weight[i] / (w * tapered) - 1) < 2e-7);
    });
  }
}

/// briggsbwtaper and briggsabs as CASA's documentation writes them, with weights of 1/σ², four times ours.
BOOST_DATA_TEST_CASE(further_weights_of_briggs_are_their_formulas, bdata::make({1e-3, 0.02, 0.1, 1.5}), bandwidth) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const PlainDensity plain(geometry, blocks);
  const double robust = -0.7, noise_jy = 0.3;
  const auto tapered = weights_of(
                 stored(blocks),
                 {.weighting = Weighting::briggs_bandwidth_taper, .robust = robust, .fractional_bandwidth = bandwidth}, 1),
             absolute =
                 weights_of(stored(blocks), {.weighting = Weighting::briggs_abs, .robust = robust, .noise_jy = noise_jy}, 1);
  double sum_square = 0, sum = 0;
  for (const auto& [cell, weight] : plain.cells()) {
    sum_square += std::pow(4 * weight, 2);
    sum += 4 * weight;
  }
  const double f2 = std::pow(5 * std::pow(10, -robust), 2) / (sum_square / sum);
  bool near = false, far = false;
  for (const VisibilityBlock& block : blocks) {
    const auto by_taper = weighted(*tapered, block), by_absolute = weighted(*absolute, block);
    plain.for_each(block, [&](std::size_t row, std::size_t channel, const PlainDensity::Cell& cell, std::uint32_t) {
      const std::size_t i = row * block.channels() + channel;
      const double w = 4 * double{block.weight[i]}, density = 4 * plain.at(cell);
      const double lambda_m = speed_of_light_m_s / block.frequency_hz[channel];
      const double u_cells = block.uvw_m[3 * row] / lambda_m * geometry.width * cell_rad,
                   v_cells = block.uvw_m[3 * row + 1] / lambda_m * geometry.height * cell_rad;
      const double r = bandwidth * std::sqrt(u_cells * u_cells + v_cells * v_cells);
      const double m = r < 1 ? (4 - r) / (4 - 2 * r) : r + 0.5;
      (r < 1 ? near : far) = true;
      // Three roundings to single precision.
      BOOST_TEST(std::abs(4 * by_taper->weight[i] / (w / (1 + density * f2 / m)) - 1) < 3e-7);
      BOOST_TEST(std::abs(4 * by_absolute->weight[i] / (w / (density * robust * robust + 2 * noise_jy * noise_jy)) - 1) < 3e-7);
    });
  }
  if (bandwidth <= 0.1) BOOST_TEST(near);
  if (bandwidth >= 0.1) BOOST_TEST(far);
}

BOOST_DATA_TEST_CASE(what_is_usable_stays_usable, bdata::xrange(every_way.size()), way) {
  const std::vector<VisibilityBlock> blocks = some_blocks();
  WeightingOptions options = every_way[way];
  if (options.taper) options.taper = taper_of_radii({10, 10, 0});  // of which hardly anything is left
  const auto weights = weights_of(stored(blocks), options, 1);
  for (const VisibilityBlock& block : blocks) {
    const auto made = weighted(*weights, block);
    for (std::size_t i = 0; i < block.samples(); ++i) BOOST_TEST((made->weight[i] > 0) == (block.weight[i] > 0));
  }
}

BOOST_DATA_TEST_CASE(threads_and_whether_blocks_are_kept_leave_every_bit, bdata::xrange(every_way.size()), way) {
  const StoredVisibilities source = stored(some_blocks());
  std::vector<float> expected;
  WeightSums sums;
  WSpread spread;
  for (const auto& [keep, threads] : {std::pair{true, 1}, {true, 3}, {false, 2}}) {
    StreamedVisibilities streamed(source, {.keep = keep});
    streamed.apply(weights_of(streamed, every_way[way], threads), threads);
    const std::vector<float> first = weights_of_a_pass(streamed);
    BOOST_CHECK(weights_of_a_pass(streamed) == first);
    BOOST_TEST(streamed.counts().used == 3000U);
    if (expected.empty()) {
      expected = first;
      sums = streamed.weight_sums();
      spread = streamed.w_spread();
    }
    BOOST_CHECK(first == expected);
    BOOST_TEST(streamed.weight_sums().noise_jy() == sums.noise_jy());
    BOOST_TEST(streamed.w_spread().weighted_w_square == spread.weighted_w_square);
  }
  double weight = 0;
  for (const float w : expected) weight += double{w};
  BOOST_TEST(std::abs(spread.weight / weight - 1) < 1e-13);
  BOOST_TEST(std::abs(sums.image / weight - 1) < 1e-6);  // single precision
}

BOOST_AUTO_TEST_CASE(blocks_that_nobody_else_holds_are_weighed_where_they_lie_and_others_stay_as_they_are) {
  const auto weights = weights_of(stored(some_blocks()), every_way[0], 1);
  const VisibilityBlock block = some_blocks().front();
  const auto held = std::make_shared<const VisibilityBlock>(block);
  const auto copy = weights->of(held).block;
  BOOST_CHECK(held->weight == block.weight);
  BOOST_CHECK(copy->weight != block.weight);
  auto alone = std::make_shared<VisibilityBlock>(block);
  const VisibilityBlock* const where = alone.get();
  const auto same = weights->of(std::move(alone)).block;
  BOOST_TEST(same.get() == where);
  BOOST_CHECK(same->weight == copy->weight);
  BOOST_CHECK(same->visibility == block.visibility);
}

BOOST_AUTO_TEST_CASE(evenly_spread_samples_tapered_by_a_beam_have_it_as_their_psf) {
  const Beam asked{6e-5, 4e-5, 0.5};
  const ImageGeometry image{48, 48, cell_rad, {}};
  const ImagingWeights weights(image, {.taper = taper_of_beam(asked)});
  const StoredVisibilities source = stored({*weighted(weights, even_samples())});
  const DirtyImages made = make_dirty_images(source, DirectTransform(image, 2), {.with_psf = true}, {});
  double largest = 0;
  const double sine = std::sin(asked.position_angle_rad), cosine = std::cos(asked.position_angle_rad);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double l = image.l(column), m = image.m(row);
      const double along = (l * sine + m * cosine) / asked.major_rad, across = (m * sine - l * cosine) / asked.minor_rad;
      const double gaussian = std::exp(-4 * std::log(2) * (along * along + across * across));
      largest = std::max(largest, std::abs(made.psf.at(row, column) - gaussian));
    }
  // What is left of the taper at the plane's edge: exp(−(π 4)²/(16 ln 2)) = 7e-7.
  BOOST_TEST(largest < 2e-6);
}

BOOST_DATA_TEST_CASE(the_noise_of_an_image_is_the_one_predicted, bdata::make({-1, 0, 2, 4, 5}), way) {
  // Visibilities of noise whose σ² is 1/(4 w), w from 0.5 to 1.5, over a plane that is crowded in the middle.
  const ImageGeometry image{256, 256, cell_rad, {}};
  std::vector<VisibilityBlock> blocks{random_samples(3000, 2, cell_rad, 1), random_samples(6000, 2, cell_rad, 2, 0.3)};
  for (VisibilityBlock& block : blocks)
    for (std::size_t i = 0; i < block.samples(); ++i) block.visibility[i] /= 2 * std::sqrt(block.weight[i]);
  StoredVisibilities source = stored(blocks);
  WeightSums sums;
  if (way >= 0) {
    WeightingOptions options = every_way[static_cast<std::size_t>(way)];
    sums = make_imaging_weights(source, options, image, {1})->put_on(source, 1).sums;
  }
  GriddingRequest request;
  request.geometry = image;
  request.accuracy = 1e-4;
  const auto transform = make_coplanar_transform(plan_gridding(request).options);
  const DirtyImages made = make_dirty_images(source, *transform, AdjointOptions{}, {});
  if (way < 0) sums = WeightSums::of_natural(made.sums.front().weight);
  BOOST_TEST(std::abs(sums.image / made.sums.front().weight - 1) < 1e-6);
  // The image has at least as many independent values as the beam of the sparsest of these, 12 pixels wide, leaves: 450; their
  // RMS is right to 1/√900, three of which are 10 %.
  BOOST_TEST(std::abs(root_mean_square(made.dirty.front()) / sums.noise_jy() - 1) < 0.1);
  BOOST_TEST(sums.noise_jy() >= sums.natural_noise_jy() * (1 - 1e-12));
}

BOOST_AUTO_TEST_SUITE_END()
