#include "imager/clean/tiled_psf.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(tiled_psf)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// The largest |PSF| between pixels of two squares that lie (rows, columns) of them apart, or one pixel further back, so that
/// the pixels are those of whole squares.
float plain_reach(const Image& psf, int side, int rows, int columns) {
  double largest = 0;
  for (int r = rows * side - side; r < rows * side + side; ++r)
    for (int c = columns * side - side; c < columns * side + side; ++c) {
      const int row = r + psf.height / 2, column = c + psf.width / 2;
      if (row >= 0 && row < psf.height && column >= 0 && column < psf.width)
        largest = std::max(largest, std::abs(psf.at(row, column)));
    }
  return static_cast<float>(largest);
}

}  // namespace

BOOST_DATA_TEST_CASE(reaches_are_the_largest_values_between_squares, bdata::make({1, 31, 100}) ^ bdata::make({5, 64, 71}),
                     width, height) {
  const Image image = random_image(width, height, 1);
  const TiledPsf psf(image, 2);
  for (const int side : {residual_tile_side, residual_block_side}) {
    const int scale = residual_tile_side / side, rows = psf.tiles_v() * scale, columns = psf.tiles_u() * scale;
    const Reach& reach = side == residual_tile_side ? psf.between_tiles() : psf.between_blocks();
    for (int v = 1 - rows; v < rows; ++v)
      for (int u = 1 - columns; u < columns; ++u) BOOST_REQUIRE(*reach(v, u) == plain_reach(image, side, v, u));
  }
}

BOOST_AUTO_TEST_CASE(it_is_zero_around_and_where_it_is_nan) {
  Image image = random_image(20, 13, 1);
  image.at(3, 4) = std::numeric_limits<double>::quiet_NaN();
  const TiledPsf psf(image, 2);
  for (int r = -residual_block_side; r < 13 + residual_block_side; ++r)
    for (int c = -residual_block_side; c < 20 + residual_block_side; ++c) {
      const bool within = r >= 0 && r < 13 && c >= 0 && c < 20 && (r != 3 || c != 4);
      BOOST_REQUIRE(*psf.at(r, c) == (within ? static_cast<float>(image.at(r, c)) : 0));
    }
}

BOOST_AUTO_TEST_SUITE_END()
