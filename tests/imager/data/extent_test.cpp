#include "imager/data/extent.h"

#include <boost/test/unit_test.hpp>

#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(extent)

using namespace misfit::imager;
using misfit::imager::testing::random_samples;

namespace {

constexpr double cell_rad = 1e-3;

VisibilityBlock samples(unsigned seed) {
  VisibilityBlock block = random_samples(50, 4, cell_rad, seed);
  for (std::size_t row = 0; row < block.rows(); ++row) block.uvw_m.edit()[3 * row + 2] = 3 * block.uvw_m[3 * (49 - row)];
  for (std::size_t i = 0; i < block.samples(); i += 3) block.weight[i] = 0;
  return block;
}

/// What the definitions say, sample by sample and pixel by pixel.
struct Expected {
  UvwReach reach;
  NeglectedPhase phase;
};

Expected brute_force(const std::vector<VisibilityBlock>& blocks, const ImageGeometry& geometry) {
  Expected e;
  double weights = 0;
  double weighted_square = 0;
  for (const VisibilityBlock& block : blocks)
    for (std::size_t i = 0; i < block.samples(); ++i) {
      const double weight = block.weight[i];
      if (weight == 0) continue;
      const double w =
          block.uvw_m[i / block.channels() * 3 + 2] * block.frequency_hz[i % block.channels()] / speed_of_light_m_s;
      e.reach.max_abs_w = std::max(e.reach.max_abs_w, std::abs(w));
      weights += weight;
      for (int row = 0; row < geometry.height; ++row)
        for (int column = 0; column < geometry.width; ++column) {
          const double r2 = std::pow(geometry.l(column), 2) + std::pow(geometry.m(row), 2);
          const double phase = 2 * pi * w * (std::sqrt(std::max(0.0, 1 - r2)) - 1);
          e.phase.max_rad = std::max(e.phase.max_rad, std::abs(phase));
          weighted_square += weight * phase * phase;
        }
    }
  e.phase.rms_rad = std::sqrt(weighted_square / weights / static_cast<double>(geometry.pixels()));
  return e;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_neglected_phase_is_that_of_every_usable_sample_and_pixel) {
  const std::vector<VisibilityBlock> blocks{samples(1), samples(2)};
  WSpread spread;
  for (const VisibilityBlock& block : blocks) spread.add(block);
  // 2100 cells of 1e-3 reach beyond the horizon; odd sizes and an offset put the farthest corner elsewhere.
  for (const ImageGeometry& geometry :
       {ImageGeometry{40, 31, cell_rad, {}}, ImageGeometry{9, 16, cell_rad, {}}, ImageGeometry{1, 7, cell_rad, {}},
        ImageGeometry{2100, 3, cell_rad, {}}, ImageGeometry{20, 31, cell_rad, {}, {-0.3, 0.2}},
        ImageGeometry{20, 30, cell_rad, {}, {0.003, -0.004}}, ImageGeometry{20, 31, cell_rad, {}, {0.6, -0.8}}}) {
    const Expected e = brute_force(blocks, geometry);
    const NeglectedPhase phase = neglected_w_phase(e.reach, spread, geometry);
    const auto close = boost::test_tools::tolerance(1e-8);  // 1 − n cancels in the plain formula
    BOOST_TEST(phase.max_rad == e.phase.max_rad, close);
    BOOST_TEST(max_w_phase_rad(e.reach.max_abs_w, geometry) == phase.max_rad);
    // Beyond 256 pixels the mean is taken over every few of them.
    BOOST_TEST(phase.rms_rad == e.phase.rms_rad, boost::test_tools::tolerance(geometry.width > 256 ? 0.01 : 1e-8));
  }
}

BOOST_AUTO_TEST_CASE(rows_without_a_usable_sample_may_lie_anywhere) {
  VisibilityBlock block = samples(3);
  WSpread spread;
  std::fill_n(block.weight.begin(), block.channels(), 0);
  block.uvw_m.edit()[2] = std::nan("");
  spread.add(block);
  BOOST_TEST(std::isfinite(spread.weighted_w_square));
}

BOOST_AUTO_TEST_CASE(no_samples_neglect_nothing) {
  const NeglectedPhase phase = neglected_w_phase({}, {}, {64, 64, cell_rad, {}});
  BOOST_TEST(phase.max_rad == 0);
  BOOST_TEST(phase.rms_rad == 0);
}

BOOST_AUTO_TEST_SUITE_END()
