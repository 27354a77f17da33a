#include "imager/direct/verify.h"

#include <boost/test/unit_test.hpp>

#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"

BOOST_AUTO_TEST_SUITE(verify)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int count = 400;
const ImageGeometry geometry{50, 40, 1e-5, {}};

std::vector<VisibilityBlock> samples() {
  return {random_samples(100, 3, geometry.cell_rad, 1), random_samples(80, 2, geometry.cell_rad, 2)};
}

DirtyImages images_of(const Transform& transform) {
  return make_dirty_images(stored(samples()), transform, {.with_psf = true}, {});
}

MeasuredError measured(const Transform& transform, const DirtyImages& images) {
  return measure_error(stored(samples()), transform, geometry, images, count, {2});
}

std::unique_ptr<Transform> bad_transform(int kernel_width) {
  GriddingRequest request;
  request.geometry = geometry;
  request.accuracy = 0;
  request.kernel_width = kernel_width;
  request.padding = 1.3;
  return make_coplanar_transform(plan_gridding(request).options);
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_exact_transform_has_no_error_but_rounding) {
  const DirectTransform exact(geometry, 2);
  const MeasuredError error = measured(exact, images_of(exact));
  // Sums of 460 terms in two orders.
  BOOST_TEST(error.image[0].rms < 1e-13);
  BOOST_TEST(error.image[0].max < 1e-12);
  BOOST_TEST(error.predict_rms < 1e-13);
}

BOOST_AUTO_TEST_CASE(the_error_of_a_bad_kernel_is_that_of_the_whole_image) {
  const Image exact = images_of(DirectTransform(geometry, 2)).dirty[0];
  for (const int kernel_width : {2, 3, 4}) {
    const auto transform = bad_transform(kernel_width);
    const DirtyImages images = images_of(*transform);
    const MeasuredError error = measured(*transform, images);
    const double truth = distance(images.dirty[0].pixel, exact.pixel) / norm(images.dirty[0].pixel);
    // 400 of 2000 pixels: their mean square scatters by less than a tenth.
    BOOST_TEST(error.image[0].rms < 1.5 * truth);
    BOOST_TEST(error.image[0].rms > truth / 1.5);
    BOOST_TEST(error.image[0].max >= error.image[0].rms);
  }
}

BOOST_AUTO_TEST_CASE(no_pixel_of_a_small_image_is_left_out) {
  const auto transform = bad_transform(3);
  const auto few_samples = stored({random_samples(20, 1, geometry.cell_rad, 1)});
  const DirtyImages images = make_dirty_images(few_samples, *transform, {.with_psf = true}, {});
  const Image exact = make_dirty_images(few_samples, DirectTransform(geometry, 2), {.with_psf = true}, {}).dirty[0];
  const MeasuredError error = measure_error(few_samples, *transform, geometry, images, 50 * 40, {2});
  double largest = 0;
  for (std::size_t i = 0; i < exact.pixel.size(); ++i)
    largest = std::max(largest, std::abs(images.dirty[0].pixel[i] - exact.pixel[i]));
  const double rms = norm(images.dirty[0].pixel) / std::sqrt(geometry.pixels());
  // The same sums in another order, whose rounding is that much less than the error.
  constexpr double rounding = 1e-9;
  BOOST_TEST(error.image[0].rms == distance(images.dirty[0].pixel, exact.pixel) / norm(images.dirty[0].pixel),
             boost::test_tools::tolerance(rounding));
  BOOST_TEST(error.image[0].max == largest / rms, boost::test_tools::tolerance(rounding));
}

BOOST_AUTO_TEST_CASE(the_error_of_prediction_is_that_of_all_samples) {
  const VisibilityBlock block = random_samples(2000, 1, geometry.cell_rad, 3);
  const Image model = random_image(geometry.width, geometry.height, 4);
  for (const int kernel_width : {2, 3, 4}) {
    const auto transform = bad_transform(kernel_width);
    const double truth =
        relative_error(transform->predict(model)->at(block), DirectTransform(geometry, 2).predict(model)->at(block));
    const double is = measured(*transform, images_of(*transform)).predict_rms;
    // Another model and other samples, as random as these.
    BOOST_TEST(is < 1.5 * truth);
    BOOST_TEST(is > truth / 1.5);
  }
}

BOOST_AUTO_TEST_CASE(every_stokes_parameter_has_an_error_of_its_own) {
  VisibilityBlock block = with_others(random_samples(100, 3, geometry.cell_rad, 1), 2, 7);
  std::fill_n(block.visibility.end() - static_cast<std::ptrdiff_t>(block.samples()), block.samples(), 0.0F);
  const auto transform = bad_transform(3);
  const auto error_of = [&](const VisibilityBlock& of, int images) {
    const StoredVisibilities source = stored({of});
    return measure_error(source, *transform, geometry, make_dirty_images(source, *transform, {images, true}, {}), count, {2});
  };
  const MeasuredError all = error_of(block, 3);
  for (const std::size_t i : {0U, 1U}) {
    const MeasuredError one = error_of(alone(block, i), 1);
    BOOST_TEST(all.image[i].rms == one.image[0].rms);
    BOOST_TEST(all.image[i].max == one.image[0].max);
  }
  BOOST_TEST(all.image[2].max == 0);
}

BOOST_AUTO_TEST_CASE(a_neglected_w_counts_as_error) {
  const ImageGeometry wide{50, 40, 1e-2, {}};
  VisibilityBlock block = random_samples(100, 1, wide.cell_rad, 5);
  for (std::size_t row = 0; row < 100; ++row) block.uvw_m.edit()[3 * row + 2] = 30;
  GriddingRequest request;
  request.geometry = wide;
  const auto transform = make_coplanar_transform(plan_gridding(request).options);
  const DirtyImages images = make_dirty_images(stored({block}), *transform, {.with_psf = true}, {});
  const MeasuredError error = measure_error(stored({block}), *transform, wide, images, count, {2});
  BOOST_TEST(error.image[0].rms > 0.1);
  BOOST_TEST(error.predict_rms > 0.1);
}

BOOST_AUTO_TEST_CASE(only_pixels_above_the_horizon_are_compared) {
  const ImageGeometry sky{50, 40, 0.05, {}, {0.3, -0.2}};
  const auto chosen = random_pixels(sky, count);
  BOOST_TEST(chosen.size() == std::size_t{count});
  for (const Pixel& pixel : chosen) BOOST_TEST(!beyond_horizon(sky.at(pixel.row, pixel.column)));
  BOOST_TEST(random_pixels({50, 40, 1e-3, {}, {1, 1}}, count).empty());

  const StoredVisibilities source = stored({random_samples_with_w(100, 2, sky.cell_rad, 20, 6)});
  const DirectTransform exact(sky, 2);
  const DirtyImages images = make_dirty_images(source, exact, {.with_psf = true}, {});
  const MeasuredError error = measure_error(source, exact, sky, images, count, {2});
  // Sums of 200 terms in two orders.
  BOOST_TEST(error.image[0].rms < 1e-13);
  BOOST_TEST(error.image[0].max < 1e-12);
  BOOST_TEST(error.predict_rms < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
