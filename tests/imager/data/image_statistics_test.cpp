#include "imager/data/image_statistics.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(image_statistics)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using misfit::imager::testing::random_image;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Widths that fill vectors of any length, and that do not.
const auto widths = bdata::make({0, 1, 2, 7, 8, 31, 32, 33, 1000});

/// Every fifth pixel is NaN.
Image holed(int width) {
  Image image = random_image(width, 1, 1);
  for (int c = 2; c < width; c += 5) image.at(0, c) = no_number;
  return image;
}

bool same(const ImageStatistics& a, const ImageStatistics& b) {
  return a.count == b.count && a.square_sum == b.square_sum && a.least == b.least && a.largest == b.largest;
}

}  // namespace

BOOST_DATA_TEST_CASE(they_are_those_of_the_pixels_that_are_not_nan, widths, width) {
  const Image image = holed(width);
  std::vector<double> number;
  std::copy_if(image.pixel.begin(), image.pixel.end(), std::back_inserter(number), [](double x) { return x == x; });
  double square_sum = 0;
  for (const double x : number) square_sum += x * x;
  const ImageStatistics is = statistics_of(image);
  BOOST_TEST(is.count == number.size());
  BOOST_TEST(std::abs(is.square_sum - square_sum) <= 1e-13 * square_sum);  // a thousand additions, each rounded
  BOOST_TEST(is.least == (number.empty() ? 0 : *std::min_element(number.begin(), number.end())));
  BOOST_TEST(is.largest == (number.empty() ? 0 : *std::max_element(number.begin(), number.end())));
  BOOST_TEST(is.largest_magnitude() == std::max(std::abs(is.least), std::abs(is.largest)));
}

BOOST_DATA_TEST_CASE(dividing_tells_the_statistics_of_the_quotients, widths, width) {
  const Image image = holed(width);
  Image divided = image;
  const ImageStatistics told = divide(divided, 3.7);
  for (std::size_t i = 0; i < image.pixel.size(); ++i)
    BOOST_TEST((divided.pixel[i] == image.pixel[i] / 3.7 || (std::isnan(divided.pixel[i]) && std::isnan(image.pixel[i]))));
  BOOST_TEST(same(told, statistics_of(divided)));
}

BOOST_AUTO_TEST_CASE(the_mean_of_squares_is_over_what_counts) {
  Image image(4, 1);
  image.pixel = {3, no_number, -4, 0};
  BOOST_TEST(statistics_of(image).root_mean_square() == std::sqrt(25.0 / 3));
  image.pixel = {no_number, no_number, no_number, no_number};
  BOOST_TEST(same(statistics_of(image), {}));
  BOOST_TEST(statistics_of(image).root_mean_square() == 0);
}

BOOST_AUTO_TEST_CASE(infinities_count) {
  Image image = random_image(20, 3, 2);
  image.at(1, 7) = -std::numeric_limits<double>::infinity();
  BOOST_TEST(statistics_of(image).largest_magnitude() == std::numeric_limits<double>::infinity());
  BOOST_TEST(find_peak(image).row == 1);
  BOOST_TEST(find_peak(image).column == 7);
}

BOOST_AUTO_TEST_SUITE_END()
