#include "imager/plan/accurate_imaging.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/data/noise.h"
#include "imager/direct/direct_transform.h"
#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"

BOOST_AUTO_TEST_SUITE(accurate_imaging)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5;

GriddingRequest request(int width, int height, double accuracy) {
  GriddingRequest r;
  r.geometry = {width, height, cell_rad, {}};
  r.accuracy = accuracy;
  r.threads = 2;
  return r;
}

AccurateImages images_of(const VisibilityBlock& block, const GriddingRequest& r) {
  return make_accurate_images(stored({block}), plan_gridding(r), {});
}

Image direct_image(const VisibilityBlock& block, const ImageGeometry& geometry) {
  const auto sum = DirectTransform(geometry, 2).adjoint({});
  sum->add(block);
  AdjointResult result = sum->finish();
  for (double& pixel : result.images[0].pixel) pixel /= result.sums[0].weight;
  return result.images[0];
}

/// Samples that see one source of 1 Jy this many cells to the west and north, and nothing else.
VisibilityBlock samples_of_a_source(std::size_t rows, double west, double north, unsigned seed) {
  VisibilityBlock block = random_samples(rows, 1, cell_rad, seed);
  const auto exact = predict_sources({{{-west * cell_rad, north * cell_rad}, 1}}, block, 2);
  block.visibility.assign(exact.begin(), exact.end());
  return block;
}

/// Every sample twice, the second time with −0.9999 of its visibility: the image is 1e4 times weaker than the data.
VisibilityBlock nearly_cancelling(VisibilityBlock block) {
  const std::size_t rows = block.rows();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) block.uvw_m.edit().push_back(block.uvw_m[3 * row + axis]);
    block.visibility.push_back(block.visibility[row] * -0.9999F);
    block.weight.push_back(block.weight[row]);
  }
  return block;
}

VisibilityBlock nearly_cancelling(unsigned seed) {
  return nearly_cancelling(random_samples(200, 1, cell_rad, seed));
}

bool has_second_pass(const GriddingPlan& plan) {
  for (const Decision& decision : plan.decisions)
    if (decision.item == "second pass") return true;
  return false;
}

}  // namespace

BOOST_DATA_TEST_CASE(random_data_are_imaged_to_the_accuracy_in_one_pass, bdata::make({1e-2, 1e-4, 1e-6, 1e-9}), accuracy) {
  const VisibilityBlock block = random_samples(400, 2, cell_rad, 1);
  const AccurateImages made = images_of(block, request(48, 40, accuracy));
  const Image exact = direct_image(block, made.plan.options.geometry);
  BOOST_TEST(made.promise_kept);
  BOOST_TEST(relative_error(made.images.dirty[0].pixel, exact.pixel) <= accuracy);
}

BOOST_DATA_TEST_CASE(a_single_visibility_anywhere_in_its_cell_keeps_the_promise, bdata::make({2, 3, 8, 15, 40}), size) {
  for (const double accuracy : {1e-3, 1e-6}) {
    const GriddingRequest r = request(size, size, accuracy);
    const GriddingPlan plan = plan_gridding(r);
    VisibilityBlock block = random_samples(1, 1, cell_rad, 8);
    const double lambda_m = speed_of_light_m_s / block.frequency_hz[0];
    const auto transform = make_coplanar_transform(plan.options);
    double worst = 0;
    for (double offset = 0; offset < 1; offset += 0.125) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        block.uvw_m.edit()[axis] = (5 + offset) * lambda_m / ((axis == 0 ? plan.options.nu : plan.options.nv) * cell_rad);
      const Image image = make_dirty_images(stored({block}), *transform, AdjointOptions{}, {}).dirty[0];
      worst = std::max(worst, relative_error(image.pixel, direct_image(block, r.geometry).pixel));
    }
    BOOST_TEST(worst <= accuracy);
  }
}

BOOST_DATA_TEST_CASE(a_strong_source_outside_an_empty_field_breaks_no_promise_silently,
                     bdata::make({41.0, 50.0, 200.5}) * bdata::make({100U, 2000U, 15000U}) * bdata::make({1e-3, 1e-6}), west,
                     rows, accuracy) {
  // In many more samples than pixels the kernel's errors add in phase, and only direct sums show it.
  const VisibilityBlock block = samples_of_a_source(rows, west, 7, 2);
  const AccurateImages made = images_of(block, request(32, 32, accuracy));
  const Image exact = direct_image(block, made.plan.options.geometry);
  const double error = relative_error(made.images.dirty[0].pixel, exact.pixel);
  BOOST_TEST((error <= accuracy || !made.promise_kept), "error " << error << " promise " << made.promise_kept);
}

BOOST_AUTO_TEST_CASE(visibilities_that_cancel_are_imaged_again_with_a_better_kernel) {
  const VisibilityBlock block = nearly_cancelling(3);
  const AccurateImages made = images_of(block, request(40, 40, 1e-5));
  const Image exact = direct_image(block, made.plan.options.geometry);
  BOOST_TEST(has_second_pass(made.plan));
  BOOST_TEST(made.promise_kept);
  BOOST_TEST(relative_error(made.images.dirty[0].pixel, exact.pixel) <= 1e-5);
}

BOOST_DATA_TEST_CASE(the_promise_holds_for_every_stokes_parameter_one_of_zeros_too, bdata::make({false, true}), own_psf) {
  const VisibilityBlock weak = nearly_cancelling(3);
  VisibilityBlock block = together(alone(with_others(weak, 1, 9), 1), weak);
  block.visibility.resize(3 * block.samples());  // the last all zeros
  GriddingRequest r = request(40, 40, 1e-5);
  r.stokes = 3;
  r.samples = block.samples();
  r.psf_accuracy = own_psf ? 1e-2 : 0;
  r.padding = 2;  // nothing is summed directly
  const AccurateImages made = images_of(block, r);
  BOOST_TEST(made.promise_kept);
  BOOST_TEST(has_second_pass(made.plan));
  for (const std::size_t i : {0U, 1U})
    BOOST_TEST(relative_error(made.images.dirty[i].pixel, direct_image(alone(block, i), r.geometry).pixel) <= 1e-5);
  BOOST_TEST(norm(made.images.dirty[2].pixel) == 0);
  BOOST_TEST(made.images.psf.at(20, 20) == 1, boost::test_tools::tolerance(1e-2));
  const TheoreticalError none = theoretical_error(made.plan, made.images.sums[2], root_mean_square(made.images.dirty[2]), {});
  BOOST_TEST(none.bound_max == 0);
}

BOOST_AUTO_TEST_CASE(images_that_begin_clean_are_as_exact_as_the_psf_unless_that_leaves_the_promise_open) {
  GriddingRequest r = request(300, 300, 1e-8);
  r.geometry.cell_rad = 1e-3;
  r.psf_accuracy = 1e-2;
  r.samples = 1'000'000;  // as if they took long
  r.max_abs_w = 300;
  const auto made_of = [&r](const VisibilityBlock& block) {
    AccurateImages made = make_accurate_images(stored({block}), plan_gridding(r), {}, nullptr, {}, true);
    BOOST_TEST_REQUIRE(made.plan.psf);
    return made;
  };
  const VisibilityBlock block = random_samples_with_w(100, 1, r.geometry.cell_rad, 200, 3);
  const AccurateImages made = made_of(block);
  const Image exact = direct_image(block, r.geometry);
  BOOST_TEST(made.promise_kept);
  BOOST_TEST(made.dirty_accuracy == 1e-2);
  BOOST_TEST(relative_error(made.images.dirty[0].pixel, exact.pixel) <= 1e-2);
  const AccurateImages shown = images_of(block, r);
  BOOST_TEST(shown.dirty_accuracy == 0);
  BOOST_TEST(relative_error(shown.images.dirty[0].pixel, exact.pixel) <= 1e-8);
  BOOST_TEST(relative_error(shown.images.psf.pixel, made.images.psf.pixel) <= 2e-2);

  r.accuracy = 1e-6;
  const VisibilityBlock cancelling = nearly_cancelling(block);
  const AccurateImages weak = made_of(cancelling);
  BOOST_TEST(weak.dirty_accuracy == 0);
  BOOST_TEST(weak.promise_kept);
  BOOST_TEST(has_second_pass(weak.plan));
  BOOST_TEST(relative_error(weak.images.dirty[0].pixel, direct_image(cancelling, r.geometry).pixel) <= 1e-6);
}

BOOST_AUTO_TEST_CASE(an_image_too_weak_for_any_kernel_is_said_to_be) {
  VisibilityBlock block = random_samples(2, 1, cell_rad, 4);
  for (std::size_t i = 0; i < 3; ++i) block.uvw_m.edit()[3 + i] = block.uvw_m[i];
  block.weight = {1, 1};
  block.visibility = {{1, 0}, {-1.0F + 1e-7F, 0}};
  BOOST_TEST(!images_of(block, request(40, 40, 1e-10)).promise_kept);
}

BOOST_AUTO_TEST_CASE(without_an_accuracy_there_is_no_promise_to_break) {
  GriddingRequest r = request(40, 40, 0);
  r.kernel_width = 2;
  const AccurateImages made = images_of(samples_of_a_source(100, 50, 0, 5), r);
  BOOST_TEST(made.promise_kept);
  BOOST_TEST(!has_second_pass(made.plan));
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(no_data_exceed_the_bounds_even_where_all_errors_align,
                     bdata::make({1, 2, 4, 7, 11}) * bdata::make({0.0, 0.25, 0.5}), kernel_width, offset) {
  for (const double padding : {1.15, 2.0})
    for (const int size : {6, 33}) {
      GriddingRequest r = request(size, size, 0);
      r.kernel_width = kernel_width;
      r.padding = padding;
      const GriddingPlan plan = plan_gridding(r);
      // All samples `offset` of a cell from a grid point, their phases those of a source on the corner pixel.
      VisibilityBlock block = samples_of_a_source(1, 0, 0, 6);
      block.uvw_m.edit().clear();
      const double lambda_m = speed_of_light_m_s / block.frequency_hz[0];
      for (int p = -9; p < 9; ++p)
        for (int q = -9; q < 9; ++q) {
          block.uvw_m.edit().push_back((p + offset) * lambda_m / (plan.options.nu * cell_rad));
          block.uvw_m.edit().push_back((q + offset) * lambda_m / (plan.options.nv * cell_rad));
          block.uvw_m.edit().push_back(0);
        }
      block.weight.assign(block.samples(), 1);
      const auto exact = predict_sources({{{r.geometry.l(0), r.geometry.m(0)}, 1}}, block, 2);
      block.visibility.assign(exact.begin(), exact.end());

      const AccurateImages made = images_of(block, r);
      const Image direct = direct_image(block, r.geometry);
      const double rms = root_mean_square(direct);
      const TheoreticalError error = theoretical_error(plan, made.images.sums[0], rms, {});
      double largest = 0;
      for (std::size_t i = 0; i < direct.pixel.size(); ++i)
        largest = std::max(largest, std::abs(made.images.dirty[0].pixel[i] - direct.pixel[i]) / rms);
      BOOST_TEST_CONTEXT("padding " << padding << " size " << size) {
        BOOST_TEST(relative_error(made.images.dirty[0].pixel, direct.pixel) <= error.bound_rms + 1e-14);
        BOOST_TEST(largest <= error.bound_max + 1e-14);
      }
    }
}

BOOST_AUTO_TEST_CASE(the_bounds_count_a_neglected_w) {
  const ImageGeometry geometry{40, 30, 1e-3, {}};
  for (const double w : {1.0, 30.0, 1000.0}) {
    VisibilityBlock block = random_samples(50, 1, geometry.cell_rad, 7);
    WSpread spread;
    for (std::size_t row = 0; row < 50; ++row) block.uvw_m.edit()[3 * row + 2] = w;
    spread.add(block);
    GriddingRequest r = request(40, 30, 1e-6);
    r.geometry = geometry;
    const AccurateImages made = images_of(block, r);
    const Image direct = direct_image(block, geometry);
    const NeglectedPhase phase = neglected_w_phase({0, 0, w * block.frequency_hz[0] / speed_of_light_m_s}, spread, geometry);
    const TheoreticalError error = theoretical_error(made.plan, made.images.sums[0], root_mean_square(direct), phase);
    BOOST_TEST(relative_error(made.images.dirty[0].pixel, direct.pixel) <= error.bound_rms);
    BOOST_TEST(error.expected_rms <= error.bound_rms);
  }
}

BOOST_AUTO_TEST_CASE(the_root_mean_square_is_of_all_pixels) {
  Image image(2, 2);
  image.at(0, 1) = -4;
  BOOST_TEST(root_mean_square(image) == 2);
  BOOST_TEST(root_mean_square(Image()) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
