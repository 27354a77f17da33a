#include "imager/noise.h"

#include <boost/test/unit_test.hpp>

#include "tests/imager/comparison.h"

using namespace misfit::imager;
using misfit::imager::testing::random_image;

BOOST_AUTO_TEST_SUITE(noise)

BOOST_AUTO_TEST_CASE(normal_pixels_have_their_standard_deviation) {
  Image image = random_image(300, 300, 1);
  for (double& pixel : image.pixel) pixel = 3 + 0.2 * pixel;
  // The median deviation of N normal values scatters by 1.17/√N = 0.4%.
  BOOST_TEST(robust_noise(image) == 0.2, boost::test_tools::tolerance(0.015));
}

BOOST_AUTO_TEST_CASE(a_few_bright_sources_hardly_change_it) {
  Image image = random_image(300, 300, 1);
  const double before = robust_noise(image);
  for (std::size_t i = 0; i < image.pixel.size(); i += 100) image.pixel[i] = 1e6;
  // One pixel in a hundred at one end moves a median by 1% of a quantile: 0.01/(2 · 2 φ(0.67)) / 0.67 ≈ 1.2% of the deviation.
  BOOST_TEST(robust_noise(image) == before, boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(an_image_of_one_value_has_none) {
  Image image(5, 4);
  BOOST_TEST(robust_noise(image) == 0);
  std::fill(image.pixel.begin(), image.pixel.end(), -2.0);
  BOOST_TEST(robust_noise(image) == 0);
  BOOST_TEST(robust_noise(Image()) == 0);
}

BOOST_AUTO_TEST_CASE(the_peak_is_the_largest_magnitude_and_the_first_of_equals) {
  Image image(5, 4);
  image.at(1, 3) = 2;
  image.at(2, 0) = -3;
  image.at(3, 4) = 3;
  const Peak peak = find_peak(image);
  BOOST_TEST(peak.row == 2);
  BOOST_TEST(peak.column == 0);
  BOOST_TEST(peak.value == -3);
}

BOOST_AUTO_TEST_SUITE_END()
