#include "tests/imager/clean/convolution.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>

#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(convolution)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// The definition.
Image plain(const Image& image, const Image& psf) {
  Image sum(image.width, image.height);
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c)
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const int psf_row = y - r + psf.height / 2, psf_column = x - c + psf.width / 2;
          if (psf_row >= 0 && psf_row < psf.height && psf_column >= 0 && psf_column < psf.width)
            sum.at(y, x) += image.at(r, c) * psf.at(psf_row, psf_column);
        }
  return sum;
}

}  // namespace

BOOST_DATA_TEST_CASE(it_is_the_plain_sum, bdata::make({1, 2, 3, 16, 33, 40}) ^ bdata::make({1, 5, 1, 16, 21, 31}), width,
                     height) {
  const Image image = random_image(width, height, 1), psf = random_image(width, height, 2);
  const std::vector<double> should = plain(image, psf).pixel;
  BOOST_TEST(distance(Convolution<double>(psf, 2)(image).pixel, should) <= 1e-14 * norm(should));
  // 6e-8 an operation, a dozen of which add up in quadrature.
  BOOST_TEST(distance(Convolution<float>(psf, 2)(image).pixel, should) <= 1e-6 * norm(should));
}

BOOST_AUTO_TEST_CASE(nan_counts_as_nothing) {
  Image image = random_image(12, 9, 1), psf = random_image(12, 9, 2);
  Image image_with_nan = image, psf_with_nan = psf;
  image.at(3, 4) = psf.at(0, 0) = 0;
  image_with_nan.at(3, 4) = psf_with_nan.at(0, 0) = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST((Convolution<double>(psf_with_nan, 2)(image_with_nan).pixel == Convolution<double>(psf, 2)(image).pixel));
}

BOOST_AUTO_TEST_CASE(it_is_the_same_bit_for_bit_for_any_number_of_threads) {
  const Image image = random_image(50, 70, 1), psf = random_image(50, 70, 2);
  const std::vector<double> one = Convolution<float>(psf, 1)(image).pixel;
  for (const int threads : {2, 3, 7}) BOOST_TEST((Convolution<float>(psf, threads)(image).pixel == one));
}

BOOST_AUTO_TEST_SUITE_END()
