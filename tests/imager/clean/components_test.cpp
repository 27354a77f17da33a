#include "imager/clean/components.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "imager/clean/gaussian_blur.h"
#include "tests/imager/comparison.h"

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// Components at few places, found again and again.
std::vector<Component> repeated(int count) {
  std::vector<Component> found;
  for (int i = 0; i < count; ++i) found.push_back({i % 2, 3 + i % 5, 4 + i * 7 % 3, std::sin(i * 1.7)});
  return found;
}

double total(const Image& image) {
  return std::accumulate(image.pixel.begin(), image.pixel.end(), 0.0);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(components)

BOOST_AUTO_TEST_CASE(components_at_one_place_are_one_in_the_order_of_scale_row_and_column) {
  ComponentModel model(20, 15, {0, 3});
  model.add({{1, 2, 3, 0.5}, {0, 9, 1, 2}, {0, 9, 0, 1}, {1, 2, 3, 0.25}, {0, 1, 1, 3}, {0, 1, 1, -3}});
  const auto& is = model.components();
  BOOST_REQUIRE(is.size() == 3U);
  BOOST_TEST((is[0].scale == 0 && is[0].row == 9 && is[0].column == 0 && is[0].flux_jy == 1));
  BOOST_TEST((is[1].scale == 0 && is[1].row == 9 && is[1].column == 1 && is[1].flux_jy == 2));
  BOOST_TEST((is[2].scale == 1 && is[2].row == 2 && is[2].column == 3 && is[2].flux_jy == 0.75));
  BOOST_TEST(model.flux_jy() == 3.75);
}

BOOST_AUTO_TEST_CASE(a_model_made_anew_from_its_components_goes_on_with_the_same_bits) {
  const std::vector<Component> found = repeated(200);
  ComponentModel whole(20, 15, {0, 3}), cut(20, 15, {0, 3});
  whole.add(found);
  cut.add({found.begin(), found.begin() + 77});
  ComponentModel restored(20, 15, {0, 3});
  restored.add(cut.components());
  restored.add({found.begin() + 77, found.end()});
  BOOST_TEST((restored.image(1).pixel == whole.image(2).pixel));
}

BOOST_AUTO_TEST_CASE(points_are_pixels_and_extended_components_keep_their_flux) {
  ComponentModel model(101, 81, {0, 6});
  model.add({{0, 5, 7, 2}, {1, 40, 50, 3}});
  const Image image = model.image(2);
  BOOST_TEST(image.at(5, 7) == 2);
  // The taps' sum is 1 up to rounding of some thirty of them per axis.
  BOOST_TEST(std::abs(total(image) - 5) < 1e-13);
  // Half the peak at half the width; the grid of pixels takes nothing off a Gaussian so wide.
  BOOST_TEST(std::abs(image.at(40, 53) / image.at(40, 50) - 0.5) < 1e-12);
  BOOST_TEST(std::abs(image.at(43, 50) / image.at(40, 50) - 0.5) < 1e-12);
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_the_model_is_refused) {
  ComponentModel model(20, 15, {0});
  for (const Component& wrong : {Component{1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 15, 0, 1}, {0, 0, 20, 1}, {0, -1, 0, 1}})
    BOOST_CHECK_THROW(model.add({wrong}), std::invalid_argument);
  BOOST_TEST(model.components().empty());
}

BOOST_AUTO_TEST_CASE(the_components_of_an_image_make_that_image) {
  Image image = random_image(9, 6, 3);
  image.at(2, 3) = 0;
  ComponentModel model(9, 6, {0});
  model.add(components_of(image));
  BOOST_TEST(model.components().size() == 53U);
  BOOST_TEST((model.image(1).pixel == image.pixel));
}

BOOST_AUTO_TEST_CASE(taylor_coefficients_add_up_and_have_images_of_their_own) {
  ComponentModel model(20, 15, {0, 3});
  model.add({{0, 9, 1, 2, {-1, 0.5}}, {1, 3, 12, 0, {0.25, 0}}});
  model.add({{0, 9, 1, -2, {-2, 1}}, {0, 3, 3, 1, {1, 0}}, {0, 3, 3, -1, {-1, 0}}});
  const auto& is = model.components();
  BOOST_REQUIRE(is.size() == 2U);  // one without flux in I_0 alone stays, one without any goes
  BOOST_TEST((is[0].flux_jy == 0 && is[0].further_jy[0] == -3 && is[0].further_jy[1] == 1.5));
  BOOST_TEST(model.image(1, 0).at(9, 1) == 0);
  BOOST_TEST(model.image(1, 1).at(9, 1) == -3);
  BOOST_TEST(model.image(1, 2).at(9, 1) == 1.5);
  ComponentModel alone(20, 15, {0, 3});
  alone.add({{1, 3, 12, 0.25}});
  BOOST_TEST(model.image(1, 1).at(4, 12) == alone.image(1).at(4, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gaussian_blur)

BOOST_AUTO_TEST_CASE(it_is_the_convolution_with_a_unit_gaussian) {
  const Image image = random_image(23, 17, 5);
  for (const double fwhm : {0.5, 2.0, 7.5}) {
    Image direct(image.width, image.height);
    double sum = 0;
    const auto gaussian = [fwhm](int r, int c) { return std::exp(-4 * std::log(2.0) * (r * r + c * c) / (fwhm * fwhm)); };
    for (int r = -60; r <= 60; ++r)
      for (int c = -60; c <= 60; ++c) sum += gaussian(r, c);
    for (int r = 0; r < image.height; ++r)
      for (int c = 0; c < image.width; ++c)
        for (int y = 0; y < image.height; ++y)
          for (int x = 0; x < image.width; ++x) direct.at(r, c) += image.at(y, x) * gaussian(r - y, c - x) / sum;
    // Cut at 1e-9 of the peak in each of two axes; no more than that is lost of the sum.
    BOOST_TEST(relative_error(imager::gaussian_blur(image, fwhm, 2).pixel, direct.pixel) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(nan_counts_as_nothing) {
  Image image = random_image(23, 17, 5), zeroed = image;
  image.at(3, 4) = std::numeric_limits<double>::quiet_NaN();
  zeroed.at(3, 4) = 0;
  BOOST_TEST((imager::gaussian_blur(image, 3, 2).pixel == imager::gaussian_blur(zeroed, 3, 1).pixel));
}

BOOST_AUTO_TEST_CASE(a_width_that_is_not_above_0_is_refused) {
  for (const double width : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    BOOST_CHECK_THROW(imager::gaussian_blur(Image(3, 3), width, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
