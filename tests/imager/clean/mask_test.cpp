#include "imager/clean/mask.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(mask)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

BOOST_AUTO_TEST_CASE(what_is_neither_0_nor_nan_is_allowed) {
  for (const double value : {1.0, -1.0, 1e-30, std::numeric_limits<double>::infinity()}) BOOST_TEST(mask_allows(value));
  for (const double value : {0.0, -0.0, std::numeric_limits<double>::quiet_NaN()}) BOOST_TEST(!mask_allows(value));
}

BOOST_AUTO_TEST_CASE(pixels_that_are_not_allowed_become_nan_and_others_stay) {
  const Image image = random_image(7, 5, 1);
  Image mask(7, 5);
  BOOST_TEST(mask_is_empty(mask));
  mask.at(1, 2) = 1;
  mask.at(4, 6) = 0.5;
  mask.at(0, 0) = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(!mask_is_empty(mask));
  const Image left = masked(image, mask);
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 7; ++c) {
      const bool allowed = (r == 1 && c == 2) || (r == 4 && c == 6);
      BOOST_TEST((allowed ? left.at(r, c) == image.at(r, c) : std::isnan(left.at(r, c))));
    }
}

BOOST_AUTO_TEST_CASE(a_mask_of_another_size_is_refused) {
  BOOST_CHECK_THROW(masked(Image(4, 3), Image(3, 4)), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
