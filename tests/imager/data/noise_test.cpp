#include "imager/data/noise.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(noise)

using namespace misfit::imager;
using misfit::imager::testing::random_image;

BOOST_AUTO_TEST_CASE(normal_pixels_have_their_standard_deviation) {
  Image image = random_image(300, 300, 1);
  for (double& pixel : image.pixel) pixel = 3 + 0.2 * pixel;
  // The median deviation of N normal values scatters by 1.17/√N = 0.4%.
  BOOST_TEST(robust_noise(image) == 0.2, boost::test_tools::tolerance(0.015));
}

BOOST_AUTO_TEST_CASE(a_sample_of_a_large_image_has_its_noise) {
  const Image image = random_image(1000, 900, 2);
  // 1.17/√N of 300 000 pixels is 2.1e-3; four times that.
  BOOST_TEST(sampled_noise(image) == robust_noise(image), boost::test_tools::tolerance(0.0085));
  BOOST_TEST(sampled_noise(image) != robust_noise(image));
  const Image small = random_image(300, 200, 3);
  BOOST_TEST(sampled_noise(small) == robust_noise(small));
  BOOST_TEST(sampled_noise(Image()) == 0);
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

BOOST_AUTO_TEST_CASE(the_middle_value_is_found_where_samples_of_the_image_mislead) {
  // In an image of this size every 23rd pixel is looked at first.
  Image image(1024, 768);
  for (std::size_t i = 0; i < image.pixel.size(); ++i) image.pixel[i] = i % 23 == 0 ? 100 : static_cast<double>(i % 3);
  // Of the others a third each is 0, 1 and 2, so that the median is 1, and two thirds of deviations are 1.
  for (const int threads : {1, 2}) BOOST_TEST(robust_noise(image, threads) == 1.4826);
}

BOOST_AUTO_TEST_CASE(threads_do_not_change_it) {
  Image image = random_image(700, 500, 3);
  image.at(3, 5) = std::numeric_limits<double>::infinity();
  std::vector<double> value;
  for (const double pixel : image.pixel)
    if (std::isfinite(pixel)) value.push_back(pixel);
  const auto middle = [&] {
    std::sort(value.begin(), value.end());
    return value[value.size() / 2];
  };
  const double centre = middle();
  for (double& x : value) x = std::abs(x - centre);
  const double expected = 1.4826 * middle();
  for (const int threads : {1, 2, 3}) BOOST_TEST(robust_noise(image, threads) == expected);
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

BOOST_AUTO_TEST_CASE(pixels_that_are_nan_do_not_count) {
  const Image whole = random_image(31, 20, 1);
  Image holed(62, 20);
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 31; ++column) {
      holed.at(row, 2 * column) = std::numeric_limits<double>::quiet_NaN();
      holed.at(row, 2 * column + 1) = whole.at(row, column);
    }
  BOOST_TEST(robust_noise(holed) == robust_noise(whole));
  BOOST_TEST(root_mean_square(holed) == root_mean_square(whole));
  BOOST_TEST(find_peak(holed).value == find_peak(whole).value);
  BOOST_TEST(find_peak(holed).row == find_peak(whole).row);
  BOOST_TEST(find_peak(holed).column == 2 * find_peak(whole).column + 1);
}

BOOST_AUTO_TEST_CASE(an_image_of_nan_has_neither_noise_nor_peak) {
  Image image(5, 4);
  std::fill(image.pixel.begin(), image.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  BOOST_TEST(robust_noise(image) == 0);
  BOOST_TEST(root_mean_square(image) == 0);
  BOOST_TEST(std::isnan(find_peak(image).value));
}

BOOST_AUTO_TEST_SUITE_END()
