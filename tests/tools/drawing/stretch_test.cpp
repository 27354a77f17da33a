#include "tools/drawing/stretch.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "imager/data/noise.h"

BOOST_AUTO_TEST_SUITE(stretch)

using misfit::imager::Image;
using misfit::tools::choose_stretch;
using misfit::tools::Shades;
using misfit::tools::Stretch;
using misfit::tools::stretch_ticks;

namespace {

Image noise_image() {
  Image image(300, 200);
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, 2e-3);
  for (double& pixel : image.pixel) pixel = noise(generator);
  return image;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_noise_sets_the_limits_whatever_the_sources) {
  Image image = noise_image();
  BOOST_TEST(choose_stretch(image).knee == 0);
  image.at(100, 100) = 5;
  const Stretch stretch = choose_stretch(image);
  BOOST_TEST(stretch.high == 5);
  BOOST_TEST(std::abs(stretch.low / -6e-3 - 1) < 0.03);  // 60 000 pixels: the median deviation is good to about 0.5%
  BOOST_TEST(stretch.knee == -stretch.low);
}

BOOST_AUTO_TEST_CASE(limits_differ_for_every_image) {
  Image zero(8, 4);
  Image blank = zero;
  for (double& pixel : blank.pixel) pixel = std::numeric_limits<double>::quiet_NaN();
  Image negative = zero;
  for (double& pixel : negative.pixel) pixel = -2;
  Image model = zero;
  model.at(1, 1) = 3;
  Image dark = zero;
  dark.at(1, 1) = -3;
  for (const Image& image : {zero, blank, negative, model, dark}) {
    const Stretch stretch = choose_stretch(image);
    BOOST_TEST(stretch.low < stretch.high);
    BOOST_TEST(std::isfinite(stretch(stretch.low)));
    BOOST_TEST(!stretch_ticks(stretch).empty());
  }
  BOOST_TEST(choose_stretch(model).sparse);
}

BOOST_AUTO_TEST_CASE(ticks_lie_within_the_limits_in_rising_order) {
  for (const Stretch& stretch : {Stretch{-0.3, 1}, Stretch{-2e-6, 5e-6}, Stretch{-0.01, 40, 0.01}, Stretch{-7, 900, 2}}) {
    const auto ticks = stretch_ticks(stretch);
    BOOST_TEST(ticks.size() >= 4);
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      BOOST_TEST(ticks[k].value >= stretch.low);
      BOOST_TEST(ticks[k].value <= stretch.high * (1 + 1e-9));
      if (k > 0) BOOST_TEST(ticks[k].value > ticks[k - 1].value);
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_about_zero_reaches_as_far_down_as_up) {
  Image image = noise_image();
  const Stretch faint = choose_stretch(image, Shades::about_zero);
  BOOST_TEST(faint.low == -faint.high);
  BOOST_TEST(faint.high == std::abs(misfit::imager::find_peak(image).value));
  BOOST_TEST(faint.knee == 0);
  image.at(10, 10) = -1;
  const Stretch deep = choose_stretch(image, Shades::about_zero);
  BOOST_TEST(deep.low == -1);
  BOOST_TEST(deep.high == 1);
  BOOST_TEST(std::abs(deep.knee / 6e-3 - 1) < 0.03);
}

BOOST_AUTO_TEST_CASE(components_of_one_sign_have_no_shades_of_the_other) {
  Image model(200, 100);
  for (int k = 0; k < 20; ++k) model.at(5, 5 * k) = 0.1 * (k + 1);
  const Stretch stretch = choose_stretch(model, Shades::about_zero);
  BOOST_TEST(stretch.low == 0);
  BOOST_TEST(stretch.high == 2);
  BOOST_TEST(stretch.knee == 0.1 * 3);  // two of the twenty are fainter
  model.at(50, 50) = -1e-9;
  BOOST_TEST(choose_stretch(model, Shades::about_zero).low == -2);
  for (double& pixel : model.pixel) pixel *= -1;
  BOOST_TEST(choose_stretch(model, Shades::about_zero).high == 2);
}

BOOST_AUTO_TEST_CASE(many_decades_have_no_more_than_a_dozen_marks) {
  for (const double knee : {1e-2, 1e-4, 1e-6, 1e-9}) {
    const auto ticks = stretch_ticks({-1, 1, knee});
    BOOST_TEST(ticks.size() >= 5);
    BOOST_TEST(ticks.size() <= 13);
    for (std::size_t k = 0; k < ticks.size(); ++k) BOOST_TEST(ticks[k].value == -ticks[ticks.size() - 1 - k].value);
  }
}

BOOST_AUTO_TEST_CASE(a_peak_that_is_round_but_for_rounding_is_marked) {
  const auto ticks = stretch_ticks({-0.1, 0.9999, 0.1});
  BOOST_TEST(ticks.back().label == "1");
  BOOST_TEST(ticks.back().value == 0.9999);
}

BOOST_AUTO_TEST_SUITE_END()
