#include "imager/wide/facet.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(facet)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

// Sizes around multiples of the lattice on which planes are fitted, and much larger ones.
BOOST_DATA_TEST_CASE(the_plane_of_a_whole_image_leaves_no_more_than_n_minus_1_itself_spans,
                     bdata::make({2, 3, 48, 49, 50, 95, 97, 300, 1000, 4001}) * bdata::make({1.0, 0.37}), width, height) {
  const ImageGeometry image{width, std::max(1, static_cast<int>(width * height)), 1e-6, {}};
  const Facet facet = split_into_facets(image, 1, 1).front();
  BOOST_TEST(2 * facet.reach <= 1.002 * largest_drop(image));  // its margin for pixels between those looked at
}

BOOST_DATA_TEST_CASE(no_pixel_strays_farther_from_its_facet_s_plane_than_its_reach,
                     bdata::make({37, 50, 97, 130, 300}) * bdata::make({1, 3}), width, parts) {
  const ImageGeometry image{width, 2 * width / 3, 2e-3 * 50 / width, {}, {0.01, -0.02}};
  for (const Facet& facet : split_into_facets(image, parts, parts))
    for (int row = 0; row < facet.geometry.height; ++row)
      for (int column = 0; column < facet.geometry.width; ++column)
        BOOST_TEST_REQUIRE(std::abs(facet.curvature(column, row)) <= facet.reach);
}

BOOST_AUTO_TEST_SUITE_END()
