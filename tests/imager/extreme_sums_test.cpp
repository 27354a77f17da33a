#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/numerics/constants.h"
#include "imager/plan/accurate_imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(extreme_sums)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;
constexpr double accuracy = 1e-6;  // the least that single precision is trusted with
constexpr double max_w = 1000;
/// Equal samples round alike: what the plan takes for random then adds up, by a quarter of the accuracy at most as measured.
constexpr double alike = 1.25;

GriddingRequest request(bool wide) {
  GriddingRequest r;
  r.geometry = {40, 40, cell_rad, {}};
  r.accuracy = accuracy;
  r.threads = 2;
  r.gridder = wide ? Gridder::wide : Gridder::standard;
  r.max_abs_w = wide ? max_w : 0;
  return r;
}

/// Images of these blocks, one after the other.
DirtyImages images_of(const std::vector<VisibilityBlock>& blocks, const GriddingPlan& plan) {
  BOOST_TEST_REQUIRE((plan.options.precision == Precision::single_precision));
  return make_dirty_images(stored(blocks), *make_transform(plan.options), {.with_psf = true}, {});
}

DirtyImages direct_images_of(const std::vector<VisibilityBlock>& blocks, const GriddingPlan& plan) {
  return make_dirty_images(stored(blocks), DirectTransform(plan.options.geometry, 2), {.with_psf = true}, {});
}

void check(const std::vector<VisibilityBlock>& blocks, const std::vector<VisibilityBlock>& reference, bool wide) {
  const GriddingPlan plan = plan_gridding(request(wide));
  const DirtyImages gridded = images_of(blocks, plan), exact = direct_images_of(reference, plan);
  BOOST_TEST(relative_error(gridded.dirty[0].pixel, exact.dirty[0].pixel) <= alike * accuracy);
  BOOST_TEST(relative_error(gridded.psf.pixel, exact.psf.pixel) <= alike * accuracy);
}

/// `count` equal samples somewhere.
VisibilityBlock equal_samples(std::size_t count, double w) {
  VisibilityBlock block;
  block.frequency_hz = {speed_of_light_m_s};
  for (std::size_t i = 0; i < count; ++i) {
    block.uvw_m.append({0.171 / cell_rad, 0.093 / cell_rad, w});
    block.visibility.emplace_back(0.7F, 0.1F);
    block.weight.push_back(0.3F);
  }
  return block;
}

}  // namespace

BOOST_DATA_TEST_CASE(any_number_of_equal_samples_in_one_cell_is_summed_to_the_accuracy,
                     bdata::make({false, true}) * bdata::make({150U, 450U, 3000U, 400000U}), wide, count) {
  const double w = wide ? 0.3 * max_w : 0;
  check({equal_samples(count, w)}, {equal_samples(1, w)}, wide);
}

BOOST_DATA_TEST_CASE(so_it_is_in_many_small_blocks, bdata::make({false, true}), wide) {
  const double w = wide ? 0.3 * max_w : 0;
  check(std::vector<VisibilityBlock>(500, equal_samples(100, w)), {equal_samples(1, w)}, wide);
}

BOOST_DATA_TEST_CASE(weights_and_values_of_any_size_that_floats_hold_are_imaged,
                     bdata::make({false, true}) * bdata::make({1e-36, 1e-30, 1e30, 1e36}) * bdata::make({1e-9, 1.0, 1e9}), wide,
                     weight, value) {
  VisibilityBlock block = random_samples_with_w(300, 2, cell_rad, wide ? max_w : 0, 1);
  for (float& w : block.weight) w *= static_cast<float>(weight);
  for (std::complex<float>& v : block.visibility) v *= static_cast<float>(value);
  check({block}, {block}, wide);
}

BOOST_DATA_TEST_CASE(blocks_of_the_most_unlike_weights_go_into_one_image,
                     bdata::make({false, true}) * bdata::make({false, true}), wide, rising) {
  std::vector<VisibilityBlock> blocks;
  for (const double exponent : {-30, -10, 10, 30}) {
    blocks.push_back(random_samples_with_w(200, 1, cell_rad, wide ? max_w : 0, 1));
    for (float& w : blocks.back().weight) w *= static_cast<float>(std::pow(10.0, rising ? exponent : -exponent));
  }
  check(blocks, blocks, wide);
}

BOOST_AUTO_TEST_CASE(an_accuracy_below_the_rounding_of_phases_of_w_is_refused) {
  GriddingRequest r = request(true);
  r.accuracy = 1e-9;
  r.geometry.centre = {0.3, -0.2};  // 1 − n is 0.067: phases of 7e5 turns at |w| = 1e7
  r.max_abs_w = 1e7;
  plan_gridding(r);
  r.max_abs_w = 1e8;
  BOOST_CHECK_THROW(plan_gridding(r), std::invalid_argument);
  r.accuracy = 1e-7;
  plan_gridding(r);
}

BOOST_AUTO_TEST_SUITE_END()
