#include "tools/stretch.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>

using misfit::imager::Image;
using misfit::tools::choose_stretch;
using misfit::tools::reduce;
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

BOOST_AUTO_TEST_SUITE(stretch)

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

BOOST_AUTO_TEST_CASE(a_block_keeps_its_largest_magnitude) {
  Image image(5, 3);
  image.at(0, 1) = -4;
  image.at(1, 1) = 3;
  image.at(2, 4) = std::numeric_limits<double>::quiet_NaN();
  const auto reduced = reduce(image, 3);
  BOOST_TEST(reduced.block == 2);
  BOOST_TEST(reduced.image.width == 3);
  BOOST_TEST(reduced.image.height == 2);
  BOOST_TEST(reduced.image.at(0, 0) == -4);
  BOOST_TEST(reduced.image.at(0, 1) == 0);
  BOOST_TEST(std::isnan(reduced.image.at(1, 2)));
  BOOST_TEST(reduce(image, 5).image.pixel.size() == image.pixel.size());
}

BOOST_AUTO_TEST_SUITE_END()
