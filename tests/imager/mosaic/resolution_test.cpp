#include "imager/mosaic/resolution.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "imager/beams/common_beam.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(resolution)

using namespace misfit::imager;

namespace {

constexpr double cell = 1e-5;

/// Pixels that are turned, and not square.
SkyGrid turned_grid(int width, int height) {
  SkyGrid grid = grid_of({width, height, cell, {1, 0.5, "FK5"}});
  const double c = std::cos(0.4), s = std::sin(0.4);
  grid.step = {{{-cell * c, 1.2 * cell * s}, {cell * s, 1.2 * cell * c}}};
  return grid;
}

/// A point of 2 Jy in a beam, at a place between pixels.
Image point(const SkyGrid& grid, const Beam& beam) {
  const double east = std::sin(beam.position_angle_rad), north = std::cos(beam.position_angle_rad);
  Image image(grid.width, grid.height);
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) {
      const double dc = c - 0.4 * image.width - 0.3, dr = r - 0.55 * image.height - 0.1;
      const double x = grid.step[0][0] * dc + grid.step[0][1] * dr, y = grid.step[1][0] * dc + grid.step[1][1] * dr;
      const double major = (x * east + y * north) / beam.major_rad, minor = (x * north - y * east) / beam.minor_rad;
      image.at(r, c) = 2 * std::exp(-4 * std::log(2.0) * (major * major + minor * minor));
    }
  return image;
}

}  // namespace

/// A Gaussian of five pixels is band-limited to 1e-10 at half a cycle a pixel; the beam ends before the image does.
BOOST_AUTO_TEST_CASE(a_point_in_one_beam_becomes_that_point_in_another) {
  const SkyGrid grid = turned_grid(160, 128);
  const Beam from{8 * cell, 6 * cell, 0.6}, across{9 * cell, 6.5 * cell, -0.7};
  const Beam to = common_beam({from, across});
  const Image exact = point(grid, to);
  for (const Beam& beam : {from, across}) {
    const Image image = with_beam(point(grid, beam), {beam, to}, grid, 2);
    int known = 0;
    double largest = 0;
    for (std::size_t i = 0; i < image.pixel.size(); ++i) {
      if (std::isnan(image.pixel[i])) continue;
      ++known;
      largest = std::max(largest, std::abs(image.pixel[i] - exact.pixel[i]));
    }
    BOOST_TEST(largest < 1e-7 * 2);
    BOOST_TEST(known > 140 * 108);
  }
}

BOOST_AUTO_TEST_CASE(pixels_are_unknown_where_their_gaussian_meets_unknown_ones) {
  const SkyGrid grid = turned_grid(100, 100);
  Image image(100, 100);
  for (double& pixel : image.pixel) pixel = 1;
  for (int r = 0; r < 100; ++r) image.at(r, 30) = std::numeric_limits<double>::quiet_NaN();
  const Image result = with_beam(image, {{4 * cell, 4 * cell, 0}, {8 * cell, 8 * cell, 0}}, grid, 1);
  for (const int column : {0, 1, 28, 29, 30, 31, 32, 98, 99}) BOOST_TEST(std::isnan(result.at(50, column)));
  for (const int column : {15, 45, 60, 84}) BOOST_TEST(std::abs(result.at(50, column) - 4) < 1e-5);  // the areas' ratio
  BOOST_TEST(std::isnan(result.at(1, 60)));
}

BOOST_AUTO_TEST_CASE(beams_are_compared_in_all_directions) {
  const Beam round{1e-5, 1e-5, 0}, turned{1e-5, 1e-5, 1.2};
  BOOST_TEST(of_one_resolution({round, turned, {1.0008e-5, 1e-5, 0.3}}));
  BOOST_TEST(!of_one_resolution({round, turned, {1.002e-5, 1e-5, 0.3}}));
  BOOST_TEST(!of_one_resolution({{2e-5, 1e-5, 0.1}, {2e-5, 1e-5, 0.102}}));
  BOOST_TEST(of_one_resolution({{2e-5, 1e-5, pi / 2}, {2e-5, 1e-5, -pi / 2}}));
}

BOOST_AUTO_TEST_SUITE_END()
