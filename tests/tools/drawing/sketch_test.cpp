#include "tools/drawing/sketch.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <map>

BOOST_AUTO_TEST_SUITE(sketch)

using misfit::imager::Image;
using namespace misfit::tools;

BOOST_AUTO_TEST_CASE(a_block_keeps_its_largest_magnitude) {
  Image image(5, 3);
  image.at(0, 1) = -4;
  image.at(1, 1) = 3;
  image.at(2, 4) = std::numeric_limits<double>::quiet_NaN();
  const ReducedImage reduced = reduce(image, 3);
  BOOST_TEST(reduced.block == 2);
  BOOST_TEST(reduced.image.width == 3);
  BOOST_TEST(reduced.image.height == 2);
  BOOST_TEST(reduced.image.at(0, 0) == -4);
  BOOST_TEST(reduced.image.at(0, 1) == 0);
  BOOST_TEST(std::isnan(reduced.image.at(1, 2)));
  BOOST_TEST(reduce(image, 5).image.pixel.size() == image.pixel.size());
}

BOOST_AUTO_TEST_CASE(points_spread_evenly_and_the_stronger_wins) {
  Image image(9, 7);
  image.at(3, 2) = 1;
  image.at(3, 5) = -2;
  image.at(0, 8) = 0.5;
  const Image spread = spread_points(image, 2);
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 9; ++column) {
      const bool dark = std::abs(row - 3) <= 2 && std::abs(column - 5) <= 2;
      const bool bright = std::abs(row - 3) <= 2 && column <= 4;
      const bool corner = row <= 2 && column >= 6;
      BOOST_TEST(spread.at(row, column) == (dark ? -2 : bright ? 1 : corner ? 0.5 : 0));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_point_covers_five_screen_pixels_whatever_the_image) {
  constexpr int screen = 600;
  for (const int side : {50, 200, 600, 3000}) {
    Image model(side, side);
    model.at(side / 2, side / 2) = 1;
    const Sketch made = misfit::tools::sketch(model, Shades::about_zero, screen);
    double lit = 0;
    for (const double value : made.reduced.image.pixel) lit += value == 1;
    BOOST_TEST(std::sqrt(lit) * screen / made.reduced.image.width >= 5);
    BOOST_TEST(std::sqrt(lit) * screen / made.reduced.image.width <= 12);  // a pixel of the smallest image
  }
}

BOOST_AUTO_TEST_CASE(noise_is_not_spread) {
  Image image(100, 100);
  for (std::size_t k = 0; k < image.pixel.size(); ++k) image.pixel[k] = std::sin(static_cast<double>(k * k));
  BOOST_TEST(misfit::tools::sketch(image, Shades::brightness, 100).reduced.image.pixel == image.pixel);
}

BOOST_AUTO_TEST_CASE(an_outline_leaves_every_corner_as_often_as_it_comes) {
  Image mask(8, 6);
  for (const auto& [row, column] : {std::pair{1, 1}, {1, 2}, {2, 2}, {3, 5}, {4, 6}}) mask.at(row, column) = 1;
  const std::vector<PixelSide> sides = outline(mask);
  BOOST_TEST(sides.size() == 8U + 4 + 4);  // an L of three pixels, and two that touch in a corner
  std::map<std::pair<int, int>, int> ends;
  for (const PixelSide& side : sides) {
    BOOST_TEST(std::abs(side.to_row - side.from_row) + std::abs(side.to_column - side.from_column) == 1);
    ++ends[{side.from_row, side.from_column}];
    ++ends[{side.to_row, side.to_column}];
  }
  for (const auto& [corner, count] : ends) BOOST_TEST(count % 2 == 0);
}

BOOST_AUTO_TEST_CASE(the_edge_of_the_image_is_no_outline) {
  Image mask(8, 6);
  BOOST_TEST(outline(mask).empty());
  for (double& pixel : mask.pixel) pixel = 1;
  BOOST_TEST(outline(mask).empty());
  for (int row = 0; row < 6; ++row) mask.at(row, 0) = 0;
  BOOST_TEST(outline(mask).size() == 6U);
  for (const PixelSide& side : outline(mask)) BOOST_TEST((side.from_column == 1 && side.to_column == 1));
}

BOOST_AUTO_TEST_SUITE_END()
