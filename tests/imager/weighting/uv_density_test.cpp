#include "imager/weighting/uv_density.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/weighting/cell_factors.h"
#include "tests/imager/random_samples.h"
#include "tests/imager/weighting/plain_density.h"

BOOST_AUTO_TEST_SUITE(uv_density)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;

/// Random samples of which some lie beyond the grid, and some are not usable.
VisibilityBlock some_samples() {
  VisibilityBlock block = random_samples(400, 7, cell_rad, 1, 1.2);
  for (std::size_t i = 0; i < block.samples(); i += 11) block.weight[i] = 0;
  block.uvw_m.edit()[0] = std::nan("");
  for (std::size_t c = 0; c < block.channels(); ++c) block.weight[c] = 0;
  return block;
}

UvDensity density_of(const ImageGeometry& geometry, int threads, const std::vector<VisibilityBlock>& blocks) {
  UvDensity density(geometry, threads);
  for (const VisibilityBlock& block : blocks) density.add(block);
  return density;
}

/// The same rows in blocks of `rows`.
std::vector<VisibilityBlock> cut(const VisibilityBlock& block, std::size_t rows) {
  std::vector<VisibilityBlock> parts;
  for (std::size_t row = 0; row < block.rows(); row += rows) {
    const std::size_t end = std::min(row + rows, block.rows()), channels = block.channels();
    VisibilityBlock part;
    part.frequency_hz = block.frequency_hz;
    const auto take = [&](const auto& from, std::size_t each, auto& to) {
      to.assign(from.begin() + static_cast<std::ptrdiff_t>(row * each), from.begin() + static_cast<std::ptrdiff_t>(end * each));
    };
    take(block.uvw_m, 3, part.uvw_m.edit());
    take(block.visibility, channels, part.visibility);
    take(block.weight, channels, part.weight);
    parts.push_back(part);
  }
  return parts;
}

/// The sum over the cells near `at` of the whole plane.
double box_sum(const PlainDensity& plain, const PlainDensity::Cell& at, int reach) {
  double sum = 0;
  for (int v = at.second - reach; v <= at.second + reach; ++v)
    for (int u = at.first - reach; u <= at.first + reach; ++u) sum += plain.at({u, v});
  return sum;
}

}  // namespace

BOOST_DATA_TEST_CASE(cells_hold_the_weight_of_all_samples_and_conjugates_in_them,
                     bdata::make({64, 33, 20}) ^ bdata::make({48, 31, 51}), width, height) {
  const ImageGeometry geometry{width, height, cell_rad, {}};
  const VisibilityBlock block = some_samples();
  const PlainDensity plain(geometry, {block});
  const UvDensity density = density_of(geometry, 2, {block});
  const DenseCells<float> uniform = uniform_factors(density.weights()), wider = uniform_factors(density.weights(), 2);
  plain.for_each(block, [&](std::size_t row, std::size_t, const PlainDensity::Cell& cell, std::uint32_t index) {
    BOOST_TEST_CONTEXT("row " << row) {
      // Sums of doubles in another order; a factor is single.
      BOOST_TEST(std::abs(density.weights()[index] / plain.at(cell) - 1) < 1e-13);
      BOOST_TEST(std::abs(uniform[index] * plain.at(cell) - 1) < 1e-7);
      BOOST_TEST(std::abs(wider[index] * box_sum(plain, cell, 2) - 1) < 1e-7);
    }
  });
}

BOOST_AUTO_TEST_CASE(threads_and_blocks_leave_every_bit) {
  const ImageGeometry geometry{300, 200, cell_rad, {}};
  const VisibilityBlock block = random_samples(30000, 3, cell_rad, 2, 0.1);
  const DenseCells<double> expected = density_of(geometry, 1, {block}).weights();
  BOOST_CHECK(density_of(geometry, 3, {block}).weights() == expected);
  for (const std::size_t rows : {777, 20000}) BOOST_CHECK(density_of(geometry, 2, cut(block, rows)).weights() == expected);
}

BOOST_DATA_TEST_CASE(briggs_f2_is_its_formula_over_samples_and_conjugates, bdata::make({-2.0, 0.0, 1.5}), robust) {
  const ImageGeometry geometry{64, 48, cell_rad, {}};
  const VisibilityBlock block = some_samples();
  const PlainDensity plain(geometry, {block});
  double square = 0, sum = 0;
  for (const auto& [cell, weight] : plain.cells()) square += weight * weight;
  plain.for_each(block, [&](std::size_t row, std::size_t channel, const PlainDensity::Cell&, std::uint32_t) {
    sum += 2 * double{block.weight[row * block.channels() + channel]};
  });
  const double expected = std::pow(5 * std::pow(10, -robust), 2) / (square / sum);
  BOOST_TEST(std::abs(briggs_f2(density_of(geometry, 1, {block}).weights(), robust) / expected - 1) < 1e-12);
}

BOOST_AUTO_TEST_CASE(briggs_factors_go_from_uniform_to_natural) {
  const UvDensity density = density_of({64, 48, cell_rad, {}}, 1, {some_samples()});
  const DenseCells<double>& weight = density.weights();
  const DenseCells<float> uniform = uniform_factors(weight);
  const double crowded = briggs_f2(weight, -2), sparse = briggs_f2(weight, 2);
  const DenseCells<float> low = briggs_factors(weight, crowded), high = briggs_factors(weight, sparse);
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (weight[k] == 0) continue;
    // 1/(1 + W f²) is within 1/(W f²) of uniform / f², and within W f² of 1; and single precision.
    BOOST_TEST(std::abs(low[k] * crowded / uniform[k] - 1) < 1 / (weight[k] * crowded) + 1e-6);
    BOOST_TEST(std::abs(high[k] - 1) < weight[k] * sparse + 1e-6);
  }
}

BOOST_AUTO_TEST_SUITE_END()
