#include "imager/extent.h"

#include <boost/test/unit_test.hpp>

#include "tests/imager/random_samples.h"

using namespace misfit::imager;
using misfit::imager::testing::random_samples;

namespace {

constexpr double cell_rad = 1e-3;

VisibilityBlock samples(unsigned seed) {
  VisibilityBlock block = random_samples(50, 4, cell_rad, seed);
  for (std::size_t row = 0; row < block.rows(); ++row) block.uvw_m[3 * row + 2] = 3 * block.uvw_m[3 * (49 - row)];
  for (std::size_t i = 0; i < block.samples(); i += 3) block.weight[i] = 0;
  return block;
}

/// What the definitions say, sample by sample and pixel by pixel.
struct Expected {
  UvwExtent extent;
  double max_rad = 0;
  double weighted_square = 0;
};

Expected brute_force(const std::vector<VisibilityBlock>& blocks, const ImageGeometry& geometry) {
  Expected e;
  for (const VisibilityBlock& block : blocks)
    for (std::size_t i = 0; i < block.samples(); ++i) {
      const double weight = block.weight[i];
      if (weight == 0) continue;
      const double per_m = block.frequency_hz[i % block.channels()] / speed_of_light_m_s;
      const double* uvw_m = &block.uvw_m[i / block.channels() * 3];
      const double w = uvw_m[2] * per_m;
      e.extent.max_abs_u = std::max(e.extent.max_abs_u, std::abs(uvw_m[0]) * per_m);
      e.extent.max_abs_v = std::max(e.extent.max_abs_v, std::abs(uvw_m[1]) * per_m);
      e.extent.max_abs_w = std::max(e.extent.max_abs_w, std::abs(w));
      e.extent.weight += weight;
      for (int row = 0; row < geometry.height; ++row)
        for (int column = 0; column < geometry.width; ++column) {
          const double r2 = std::pow(geometry.l(column), 2) + std::pow(geometry.m(row), 2);
          const double phase = 2 * pi * w * (std::sqrt(std::max(0.0, 1 - r2)) - 1);
          e.max_rad = std::max(e.max_rad, std::abs(phase));
          e.weighted_square += weight * phase * phase;
        }
    }
  return e;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(extent)

BOOST_AUTO_TEST_CASE(reach_and_neglected_phase_are_those_of_every_usable_sample_and_pixel) {
  const std::vector<VisibilityBlock> blocks{samples(1), samples(2)};
  UvwExtent extent;
  for (const VisibilityBlock& block : blocks) extent.add(block);
  // 2100 cells of 1e-3 reach beyond the horizon; odd sizes and an offset put the farthest corner elsewhere.
  for (const ImageGeometry& geometry :
       {ImageGeometry{40, 31, cell_rad, {}}, ImageGeometry{9, 16, cell_rad, {}}, ImageGeometry{1, 7, cell_rad, {}},
        ImageGeometry{2100, 3, cell_rad, {}}, ImageGeometry{20, 31, cell_rad, {}, {-0.3, 0.2}},
        ImageGeometry{20, 30, cell_rad, {}, {0.003, -0.004}}, ImageGeometry{20, 31, cell_rad, {}, {0.6, -0.8}}}) {
    const Expected e = brute_force(blocks, geometry);
    const NeglectedPhase phase = neglected_w_phase(extent, geometry);
    const auto close = boost::test_tools::tolerance(1e-8);  // 1 − n cancels in the plain formula
    BOOST_TEST(extent.max_abs_u == e.extent.max_abs_u, close);
    BOOST_TEST(extent.max_abs_v == e.extent.max_abs_v, close);
    BOOST_TEST(extent.max_abs_w == e.extent.max_abs_w, close);
    BOOST_TEST(extent.weight == e.extent.weight, close);
    BOOST_TEST(phase.max_rad == e.max_rad, close);
    const double rms_rad = std::sqrt(e.weighted_square / e.extent.weight / static_cast<double>(geometry.pixels()));
    // Beyond 256 pixels the mean is taken over every few of them.
    BOOST_TEST(phase.rms_rad == rms_rad, boost::test_tools::tolerance(geometry.width > 256 ? 0.01 : 1e-8));
  }
}

BOOST_AUTO_TEST_CASE(no_samples_neglect_nothing) {
  const NeglectedPhase phase = neglected_w_phase({}, {64, 64, cell_rad, {}});
  BOOST_TEST(phase.max_rad == 0);
  BOOST_TEST(phase.rms_rad == 0);
}

BOOST_AUTO_TEST_SUITE_END()
