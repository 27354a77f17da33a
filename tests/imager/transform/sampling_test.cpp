#include "imager/transform/sampling.h"

#include <boost/test/unit_test.hpp>
#include <limits>

BOOST_AUTO_TEST_SUITE(sampling)

using namespace misfit::imager;

namespace {

constexpr double cell_rad = 1e-5;

ImageGeometry image(double pixel_aspect = 1) {
  ImageGeometry geometry;
  geometry.cell_rad = cell_rad;
  geometry.pixel_aspect = pixel_aspect;
  return geometry;
}

/// One row at 1 and 2 GHz, where it lies at these turns per cell at 1 GHz.
VisibilityBlock row_at(double u_turns, double v_turns) {
  VisibilityBlock block;
  block.frequency_hz = {1e9, 2e9};
  const double metres = speed_of_light_m_s / 1e9 / cell_rad;
  block.uvw_m = {u_turns * metres, v_turns * metres, 0};
  block.visibility = {{1, 0}, {1, 0}};
  block.weight = {1, 1};
  return block;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_turn_per_two_cells_is_the_last_that_an_image_can_represent) {
  constexpr double beyond = 0.5 + std::numeric_limits<double>::epsilon();
  for (const double sign : {-1.0, 1.0}) {
    BOOST_TEST(inside_grid(0.5 * sign, 0));
    BOOST_TEST(inside_grid(0, 0.5 * sign));
    BOOST_TEST(!inside_grid(beyond * sign, 0));
    BOOST_TEST(!inside_grid(0, beyond * sign));
  }
  BOOST_TEST(!inside_grid(std::numeric_limits<double>::quiet_NaN(), 0));
}

BOOST_AUTO_TEST_CASE(samples_of_a_row_lie_inside_up_to_the_frequency_that_takes_them_out) {
  SampleSums sums;
  for (const VisibilityBlock& block : {row_at(0.3, 0), row_at(0, -0.3), row_at(-0.3, 0.1)})
    BOOST_TEST((imaging_weights(block, {image(), false, 2}, sums) == std::vector<float>{1, 0}));
  BOOST_TEST(sums.used == 3U);
  BOOST_TEST(sums.outside_grid == 3U);
}

BOOST_AUTO_TEST_CASE(samples_beyond_count_where_they_are_asked_for) {
  SampleSums sums;
  BOOST_TEST((imaging_weights(row_at(0.3, 0), {image(), true, 2}, sums) == std::vector<float>{1, 1}));
  BOOST_TEST(sums.used == 2U);
  BOOST_TEST(sums.outside_grid == 0U);
}

BOOST_AUTO_TEST_CASE(the_height_of_pixels_limits_v) {
  SampleSums sums;
  BOOST_TEST((imaging_weights(row_at(0.3, 0.1), {image(3), false, 2}, sums) == std::vector<float>{1, 0}));
  BOOST_TEST((imaging_weights(row_at(0.1, 0.3), {image(0.5), false, 2}, sums) == std::vector<float>{1, 1}));
  BOOST_TEST((imaging_weights(row_at(0.1, 0.3), {image(2), false, 2}, sums) == std::vector<float>{0, 0}));
}

BOOST_AUTO_TEST_CASE(samples_of_weight_zero_are_neither_inside_nor_counted) {
  VisibilityBlock block = row_at(0.3, 0);
  block.weight = {0, 0};
  SampleSums sums;
  BOOST_TEST((imaging_weights(block, {image(), false, 2}, sums) == std::vector<float>{0, 0}));
  BOOST_TEST(sums.used + sums.outside_grid == 0U);
}

BOOST_AUTO_TEST_CASE(sums_are_those_of_weights_and_magnitudes) {
  SampleSums sums;
  add_to_sums(sums, 2, {3, 4});
  add_to_sums(sums, 0.5, {0, -2});
  BOOST_TEST(sums.weight == 2.5);
  BOOST_TEST(sums.weight_abs == 2 * 5 + 0.5 * 2);
  BOOST_TEST(sums.weight_square == 2 * 25 + 0.5 * 4);
  BOOST_TEST(sums.weight2_square == 4 * 25 + 0.25 * 4);
  BOOST_TEST(sums.used == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
