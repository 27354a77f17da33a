#include "imager/arrays/array_transform.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <numeric>

#include "tests/imager/arrays/array_scene.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(array_transform)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = pi / 180;

/// Fields of view in degrees, pixels that are not square, off the phase centre; odd and even sizes, from 1 pixel on.
ArrayImage image_of(double field_deg, int pixels_x, int pixels_y) {
  const double pixel = field_deg * degree / std::max(pixels_x, pixels_y);
  return {pixels_x, pixels_y, pixel, 0.8 * pixel, 3 * pixel, -0.4 * pixel};
}

template <typename Real>
std::vector<Real> random_model(const ArrayImage& image) {
  const Image random = random_image(image.pixels_y, image.pixels_x, 5);
  return {random.pixel.begin(), random.pixel.end()};
}

template <typename Real>
std::vector<std::complex<Real>> predicted(const ArrayTransform& transform, const ArrayScene<Real>& scene,
                                          const std::vector<Real>& model, bool with_weight) {
  std::vector<std::complex<Real>> into(scene.visibility.size(), {7, 7});
  const auto columns = static_cast<std::size_t>(scene.image.pixels_y);
  transform.predict<Real>({model.data(), static_cast<std::size_t>(scene.image.pixels_x), columns, scene.image.pixels_y},
                          with_weight ? scene.table(scene.weight) : Strided<const Real>(),
                          {into.data(), scene.rows(), scene.channels(), static_cast<std::ptrdiff_t>(scene.channels())});
  return into;
}

template <typename Real>
std::vector<std::complex<double>> in_double(const std::vector<std::complex<Real>>& values) {
  return {values.begin(), values.end()};
}

std::string refusal_of(const ArrayTransform& transform, const ArrayScene<double>& scene) {
  try {
    transform.adjoint(scene.values());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(images_and_visibilities_equal_their_definition,
                     bdata::make({0.001, 1.0, 20.0}) * bdata::make({1e-2, 1e-5, 1e-11}) * bdata::make({1, 2, 17, 64}) *
                         bdata::make({0, 1}),
                     field_deg, accuracy, pixels, with_w) {
  const ArrayScene<double> scene(image_of(field_deg, pixels, 31), 50, 3);
  const ArrayCoordinates at = scene.at(with_w == 1);
  ArrayTransformOptions options = scene.options(accuracy);
  options.divide_by_n = true;
  options.precision = Precision::double_precision;
  const ArrayTransform transform(options, at);
  const auto image = transform.adjoint(scene.values()).image.pixel;
  BOOST_TEST(relative_error(image, direct_image(scene.image, at, scene.values(), true)) <= accuracy);
  const std::vector<double> model = random_model<double>(scene.image);
  const auto visibility = predicted(transform, scene, model, false);
  BOOST_TEST(relative_error(visibility, direct_visibilities(scene.image, at, model, true)) <= accuracy);
}

BOOST_DATA_TEST_CASE(so_they_do_by_gridding_where_direct_sums_would_be_chosen,
                     bdata::make({0.01, 20.0}) * bdata::make({3, 40}) * bdata::make({0, 1}), field_deg, pixels, with_w) {
  const ArrayScene<double> scene(image_of(field_deg, pixels, 33), 40, 2);
  const ArrayCoordinates at = scene.at(with_w == 1);
  ArrayTransformOptions options = scene.options(1e-9);
  options.kernel_width = 11;
  const ArrayTransform transform(options, at);
  BOOST_TEST(!transform.plan().direct);
  const auto image = transform.adjoint(scene.values()).image.pixel;
  BOOST_TEST(relative_error(image, direct_image(scene.image, at, scene.values(), false)) <= 1e-9);
  const std::vector<double> model = random_model<double>(scene.image);
  BOOST_TEST(relative_error(predicted(transform, scene, model, false), direct_visibilities(scene.image, at, model, false)) <=
             1e-9);
}

BOOST_DATA_TEST_CASE(single_precision_data_keep_an_accuracy_of_a_millionth, bdata::make({1e-2, 1e-6}) * bdata::make({0, 1}),
                     accuracy, with_w) {
  const ArrayScene<float> scene(image_of(5, 48, 31), 60, 3);
  const ArrayCoordinates at = scene.at(with_w == 1);
  const ArrayTransform transform(scene.options(accuracy), at);
  const auto image = transform.adjoint(scene.values()).image.pixel;
  BOOST_TEST(relative_error(image, direct_image(scene.image, at, scene.values(), false)) <= accuracy);
  const std::vector<float> model = random_model<float>(scene.image);
  const auto visibility = in_double(predicted(transform, scene, model, false));
  BOOST_TEST(relative_error(visibility, direct_visibilities(scene.image, at, model, false)) <= accuracy);
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(each_way_is_the_other_s_adjoint_up_to_rounding,
                     bdata::make({1e-1, 1e-4, 1e-10}) * bdata::make({2, 33}) * bdata::make({0, 1}) * bdata::make({0, 8}),
                     accuracy, pixels, with_w, kernel_width) {
  const ArrayScene<double> scene(image_of(10, pixels, 40), 30, 3);
  const ArrayCoordinates at = scene.at(with_w == 1);
  ArrayTransformOptions options = scene.options(std::max(accuracy, kernel_width == 0 ? 0 : 1e-4));
  options.divide_by_n = true;
  options.kernel_width = kernel_width;
  options.precision = Precision::double_precision;
  const ArrayTransform transform(options, at);
  const auto image = transform.adjoint(scene.values()).image.pixel;
  const std::vector<double> model = random_model<double>(scene.image);
  const auto visibility = predicted(transform, scene, model, true);
  double of_visibilities = 0;
  for (std::size_t i = 0; i < visibility.size(); ++i)
    of_visibilities += (std::conj(visibility[i]) * scene.visibility[i]).real();
  const double of_images = std::inner_product(image.begin(), image.end(), model.begin(), 0.0);
  BOOST_TEST(std::abs(of_images - of_visibilities) <= 1e-13 * norm(image) * norm(model));  // some hundreds of roundings
}

BOOST_AUTO_TEST_CASE(signs_turn_coordinates_and_samples_beyond_the_grid_count) {
  const ArrayScene<double> scene(image_of(3, 20, 31), 40, 2, 3);
  ArrayCoordinates at = scene.at();
  at.u_sign = at.w_sign = -1;
  for (const int kernel_width : {0, 9}) {
    ArrayTransformOptions options = scene.options(1e-7);
    options.kernel_width = kernel_width;
    const ArrayTransform transform(options, at);
    const auto image = transform.adjoint(scene.values()).image.pixel;
    BOOST_TEST(relative_error(image, direct_image(scene.image, at, scene.values(), false)) <= 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(weights_of_any_sign_multiply_visibilities) {
  ArrayScene<float> scene(image_of(3, 20, 31), 40, 2);
  scene.weight[5] = -3;
  const ArrayCoordinates at = scene.at();
  const ArrayTransform transform(scene.options(1e-6), at);
  const auto image = transform.adjoint(scene.values()).image.pixel;
  BOOST_TEST(relative_error(image, direct_image(scene.image, at, scene.values(), false)) <= 1e-6);
  const std::vector<float> model = random_model<float>(scene.image);
  auto expected = direct_visibilities(scene.image, at, model, false);
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] *= double{scene.weight[i]};
  BOOST_TEST(relative_error(in_double(predicted(transform, scene, model, true)), expected) <= 1e-6);
}

BOOST_AUTO_TEST_CASE(strides_and_threads_change_no_bit) {
  const ArrayScene<double> scene(image_of(3, 60, 70), 5000, 3);
  const ArrayCoordinates at = scene.at();
  ArrayTransformOptions options = scene.options(1e-5);
  const Image image = ArrayTransform(options, at).adjoint(scene.values()).image;
  std::vector<std::complex<double>> spread(2 * scene.visibility.size(), {no_number, no_number});
  for (std::size_t i = 0; i < scene.visibility.size(); ++i) spread[2 * i] = scene.visibility[i];
  ArrayValues<double> strided = scene.values();
  strided.visibility = {spread.data(), scene.rows(), 3, 6, 2};
  options.threads = 1;
  BOOST_TEST((ArrayTransform(options, at).adjoint(strided).image.pixel == image.pixel));
}

BOOST_AUTO_TEST_CASE(what_the_mask_leaves_out_may_hold_anything) {
  ArrayScene<double> scene(image_of(3, 20, 31), 40, 2);
  const ArrayCoordinates at = scene.at();
  const ArrayTransform transform(scene.options(1e-6), at);
  const Image image = transform.adjoint(scene.values()).image;
  for (std::size_t i = 0; i < scene.mask.size(); ++i)
    if (scene.mask[i] == 0) scene.visibility[i] = scene.weight[i] = no_number;
  BOOST_TEST((transform.adjoint(scene.values()).image.pixel == image.pixel));
  const auto visibility = predicted(transform, scene, random_model<double>(scene.image), true);
  BOOST_TEST(visibility[3] == 0.0);
}

BOOST_AUTO_TEST_CASE(rows_without_a_place_are_refused_unless_they_are_masked) {
  ArrayScene<double> scene(image_of(3, 20, 31), 40, 2);
  scene.uvw_m[3 * 17 + 1] = no_number;
  const ArrayCoordinates at = scene.at();
  const ArrayTransform transform(scene.options(1e-6), at);
  scene.mask[2 * 17] = 0;
  BOOST_TEST(refusal_of(transform, scene) == "uvw[17] is not finite, expected coordinates in metres, or a mask of 0");
  scene.mask[2 * 17 + 1] = 0;
  BOOST_TEST(refusal_of(transform, scene) == "");
}

BOOST_AUTO_TEST_CASE(values_that_are_not_finite_are_refused) {
  for (const double bad : {no_number, std::numeric_limits<double>::infinity()})
    for (const int kernel_width : {0, 7}) {
      ArrayScene<double> scene(image_of(3, 20, 31), 40, 2);
      ArrayTransformOptions options = scene.options(1e-4);
      options.kernel_width = kernel_width;
      const ArrayCoordinates at = scene.at();
      const ArrayTransform transform(options, at);
      scene.visibility[11] = bad;
      BOOST_TEST(refusal_of(transform, scene) != "");
      std::vector<double> model = random_model<double>(scene.image);
      model[4] = bad;
      BOOST_CHECK_THROW(predicted(transform, scene, model, false), std::invalid_argument);
    }
}

BOOST_AUTO_TEST_CASE(shapes_that_differ_are_refused) {
  const ArrayScene<double> scene(image_of(3, 20, 31), 40, 2), other(image_of(3, 20, 31), 40, 3);
  const ArrayCoordinates at = scene.at();
  const ArrayTransform transform(scene.options(1e-6), at);
  BOOST_TEST(refusal_of(transform, other) == "vis has the shape (40, 3), expected (40, 2), rows of uvw and channels of freq");
  ArrayCoordinates flat = at;
  flat.uvw_m.columns = 2;
  BOOST_CHECK_THROW(ArrayTransform(scene.options(1e-6), flat), std::invalid_argument);
  flat = at;
  flat.frequency_hz[1] = 0;
  BOOST_CHECK_THROW(ArrayTransform(scene.options(1e-6), flat), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(data_that_cancel_say_how_far_the_image_may_err) {
  ArrayScene<double> scene(image_of(0.01, 64, 64), 200, 1);
  for (std::size_t row = 1; row < 200; row += 2) {  // each of the even rows is taken off again next to it
    for (std::size_t k = 0; k < 3; ++k) scene.uvw_m[3 * row + k] = scene.uvw_m[3 * (row - 1) + k] * (1 + 1e-5);
    scene.visibility[row] = -scene.visibility[row - 1];
    scene.weight[row] = scene.weight[row - 1];
  }
  scene.mask.assign(scene.mask.size(), 1);
  ArrayTransformOptions options = scene.options(1e-4);
  options.kernel_width = 5;
  const ArrayCoordinates at = scene.at();
  const ArrayAdjoint made = ArrayTransform(options, at).adjoint(scene.values());
  const double error = relative_error(made.image.pixel, direct_image(scene.image, at, scene.values(), false));
  BOOST_TEST(made.expected_error > 1e-4);
  BOOST_TEST(error < 3 * made.expected_error);  // errors of neighbours cancel in part, too
}

BOOST_AUTO_TEST_CASE(the_padding_stays_within_its_bounds) {
  const ArrayScene<double> scene(image_of(1, 500, 400), 100, 1);
  const ArrayCoordinates at = scene.at(false);
  for (const auto& [least, most] : {std::pair(1.1, 1.2), std::pair(1.5, 1.5), std::pair(2.2, 2.6)}) {
    ArrayTransformOptions options = scene.options(1e-3);
    options.least_padding = least;
    options.most_padding = most;
    options.kernel_width = 9;
    const ArrayTransform transform(options, at);
    const CoplanarOptions& planned = transform.plan().options;
    constexpr double next_fast_size = 1.05;
    BOOST_TEST(planned.nu >= least * 400);
    BOOST_TEST(planned.nu <= most * 400 * next_fast_size);
    BOOST_TEST(planned.nv >= least * 500);
    BOOST_TEST(planned.nv <= most * 500 * next_fast_size);
  }
}

BOOST_AUTO_TEST_CASE(no_rows_make_an_empty_image) {
  const ArrayScene<double> scene(image_of(1, 8, 9), 0, 2);
  const ArrayCoordinates at = scene.at();
  const Image image = ArrayTransform(scene.options(1e-6), at).adjoint(scene.values()).image;
  BOOST_TEST((image.pixel == std::vector<double>(72)));
}

BOOST_AUTO_TEST_SUITE_END()
