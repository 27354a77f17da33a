#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "imager/weighting/cell_factors.h"
#include "imager/weighting/imaging_weights.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"
#include "tests/imager/weighting/plain_density.h"

BOOST_AUTO_TEST_SUITE(rank_filter)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;

/// Samples all over the plane, some beyond it, many on its edges, and more in the middle; weights differ by up to 1e8.
std::vector<VisibilityBlock> some_blocks() {
  std::vector<VisibilityBlock> blocks{random_samples(500, 2, cell_rad, 1, 1.1), random_samples(400, 2, cell_rad, 2, 0.2),
                                      random_samples(40, 1, cell_rad, 3)};
  for (std::size_t i = 0; i < blocks[0].samples(); i += 7) blocks[0].weight[i] *= 1e6F;
  for (std::size_t i = 3; i < blocks[0].samples(); i += 13) blocks[0].weight[i] *= 0.01F;
  VisibilityBlock& edges = blocks[2];
  const double edge_m = 0.5 / cell_rad * speed_of_light_m_s / edges.frequency_hz[0];
  for (std::size_t row = 0; row < edges.rows(); ++row)
    edges.uvw_m.edit()[3 * row + row % 2] = (row % 4 < 2 ? -1 : 1) * edge_m * (1 - 1e-12);
  for (std::size_t row = 0; row < 10; ++row) edges.uvw_m.edit()[3 * row + 1] = (row % 2 == 0 ? 1e-3 : -1e-3) * edge_m;
  return blocks;
}

UvDensity density_of(const ImageGeometry& geometry, const std::vector<VisibilityBlock>& blocks) {
  UvDensity density(geometry, 1);
  for (const VisibilityBlock& block : blocks) density.add(block);
  return density;
}

/// The filter by its definition, over the cells of the whole plane.
double plain_filtered(const PlainDensity& plain, const PlainDensity::Cell& at, double level, int reach,
                      double (*factor)(double)) {
  double sum = 0;
  int cells = 0;
  for (int v = at.second - reach; v <= at.second + reach; ++v)
    for (int u = at.first - reach; u <= at.first + reach; ++u)
      if (plain.at({u, v}) > 0) {
        sum += factor(plain.at({u, v}));
        ++cells;
      }
  return std::min(factor(plain.at(at)), level * sum / cells);
}

}  // namespace

BOOST_DATA_TEST_CASE(factors_are_cut_to_a_multiple_of_the_mean_about_them,
                     (bdata::make({64, 33, 20}) ^ bdata::make({48, 31, 51})) * bdata::make({0.5, 1.0, 3.0}) *
                         bdata::make({1, 2, 8, 100}),
                     width, height, level, reach) {
  const ImageGeometry geometry{width, height, cell_rad, {}};
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const PlainDensity plain(geometry, blocks);
  const UvDensity density = density_of(geometry, blocks);
  constexpr double f2 = 0.1;
  const RankFilter filter{level, reach};
  const DenseCells<float> uniform = rank_filtered(uniform_factors(density.weights()), filter);
  const DenseCells<float> briggs = rank_filtered(briggs_factors(density.weights(), f2), filter);
  const DenseCells<float> box = uniform_factors(density.weights(), reach);
  int cut = 0, next_to_zero = 0;
  std::set<std::uint32_t> seen;
  for (const VisibilityBlock& block : blocks)
    plain.for_each(block, [&](std::size_t, std::size_t, const PlainDensity::Cell& cell, std::uint32_t index) {
      if (!seen.insert(index).second) return;
      const double by_uniform = plain_filtered(plain, cell, level, reach, [](double w) { return 1 / w; });
      const double by_briggs = plain_filtered(plain, cell, level, reach, [](double w) { return 1 / (1 + w * f2); });
      // Factors are single, before and after; sums are double, and of nothing but additions.
      BOOST_TEST(std::abs(uniform[index] / by_uniform - 1) < 2e-7);
      BOOST_TEST(std::abs(briggs[index] / by_briggs - 1) < 2e-7);
      cut += by_uniform * plain.at(cell) < 1 - 1e-6 ? 1 : 0;
      next_to_zero += cell.second == 0 || cell.second == -1 ? 1 : 0;
      double sum = 0;
      if (reach > 8) return;
      for (int v = cell.second - reach; v <= cell.second + reach; ++v)
        for (int u = cell.first - reach; u <= cell.first + reach; ++u) sum += plain.at({u, v});
      BOOST_TEST(std::abs(box[index] * sum - 1) < 1e-7);  // superuniform weights sum boxes likewise
    });
  BOOST_TEST(cut > 0);
  BOOST_TEST(next_to_zero > 10);
  for (std::size_t k = 0; k < uniform.size(); ++k) BOOST_TEST((uniform[k] > 0) == (density.weights()[k] > 0));
}

BOOST_AUTO_TEST_CASE(weights_are_filtered_before_they_are_tapered) {
  const ImageGeometry geometry{64, 48, cell_rad, {}};
  const std::vector<VisibilityBlock> blocks = some_blocks();
  const UvDensity density = density_of(geometry, blocks);
  const WeightingOptions options{.weighting = Weighting::uniform,
                                 .rank_filter = RankFilter{2, 4},
                                 .taper = taper_of_radii({20e3, 20e3, 0}),
                                 .window = {.max_lambda = 40e3}};
  const DenseCells<float> factor = rank_filtered(uniform_factors(density.weights()), *options.rank_filter);
  StoredVisibilities source = stored({blocks[0]});
  const ImagingWeights weights(density, options);
  weights.put_on(source, 1);
  PlainDensity(geometry, {})
      .for_each(blocks[0], [&](std::size_t row, std::size_t c, const PlainDensity::Cell&, std::uint32_t index) {
        const double* const uvw_m = &blocks[0].uvw_m[3 * row];
        const double r = std::hypot(uvw_m[0], uvw_m[1]) * blocks[0].frequency_hz[c] / speed_of_light_m_s;
        const std::size_t i = row * blocks[0].channels() + c;
        const double expected = blocks[0].weight[i] * double{factor[index]} * std::exp2(-r * r / (20e3 * 20e3));
        const float made = source.blocks().front()->weight[i];
        if (r > 40e3)
          BOOST_TEST(made == std::numeric_limits<float>::min());
        else
          BOOST_TEST(std::abs(made / expected - 1) < 1e-7);
      });
  BOOST_TEST(weights.cells_filled() > 0U);
}

BOOST_AUTO_TEST_SUITE_END()
