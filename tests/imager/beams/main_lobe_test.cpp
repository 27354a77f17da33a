#include "imager/beams/main_lobe.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

BOOST_AUTO_TEST_SUITE(main_lobe)

namespace {

using namespace misfit::imager;

/// A sample of the uv plane in turns per pixel; all have the same weight.
struct Point {
  double u, v;
};

double height(const std::vector<Point>& points, double x, double y) {
  double sum = 0;
  for (const auto& [u, v] : points) sum += std::cos(2 * M_PI * (u * x + v * y));
  return sum / static_cast<double>(points.size());
}

Image psf_of(const std::vector<Point>& points, int size) {
  Image psf(size, size);
  for (int r = 0; r < size; ++r)
    for (int c = 0; c < size; ++c) psf.at(r, c) = height(points, size / 2 - c, r - size / 2);
  return psf;
}

std::vector<Point> square_of_points(double largest) {
  std::mt19937 random(3);
  const auto coordinate = [&] { return largest * (2 * static_cast<double>(random()) / std::mt19937::max() - 1); };
  std::vector<Point> points(60);
  for (Point& point : points) point = {coordinate(), coordinate()};
  return points;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_lobe_of_few_pixels_is_sampled_between_them) {
  const int size = 256, last = 127;
  const std::vector<Point> points = square_of_points(0.45);
  const MainLobe lobe = misfit::imager::main_lobe(psf_of(points, size));
  // Per axis the sum over |n| ≤ W of exp(2πiun) sinc(x − n) differs from exp(2πiux) by (2/π) / ((W + 1 − |x|) cos πu) at most:
  // summation by parts, where the partial sums of (−1)ⁿ exp(2πiun) are 1 / cos πu at most. The axes' errors e become 2e + e².
  double bound = 0;
  for (const auto& [u, v] : points) {
    const double axis = 2 / M_PI / ((last + 1 - 2) * std::cos(M_PI * std::max(std::abs(u), std::abs(v))));
    bound += (2 * axis + axis * axis) / static_cast<double>(points.size());
  }
  BOOST_TEST(bound < 0.03);
  BOOST_TEST(lobe.reach < 2);
  for (const LobeSample& s : lobe.samples)
    BOOST_REQUIRE(std::abs(s.value - height(points, s.east * lobe.scale, s.north * lobe.scale)) < bound);
}

BOOST_AUTO_TEST_CASE(however_coarse_the_cell_the_lobe_has_41_samples) {
  // Nothing falls faster than the coverage of the grid's corners alone, 0.49 instead of 0.5 so that the image tells them apart.
  const MainLobe corners = misfit::imager::main_lobe(psf_of({{0.49, 0.49}, {0.49, -0.49}}, 128));
  BOOST_TEST(corners.samples.size() >= 41U);
  Image uniform(32, 32);  // the whole grid covered alike
  uniform.at(16, 16) = 1;
  const MainLobe lobe = misfit::imager::main_lobe(uniform);
  BOOST_TEST(lobe.samples.size() >= 41U);
  const auto sinc = [](double t) { return t == 0 ? 1 : std::sin(M_PI * t) / (M_PI * t); };
  for (const LobeSample& s : lobe.samples)
    BOOST_REQUIRE(std::abs(s.value - sinc(s.east * lobe.scale) * sinc(s.north * lobe.scale)) < 1e-14);
}

BOOST_AUTO_TEST_CASE(a_lobe_of_30_pixels_is_its_pixels) {
  const Image psf = psf_of(square_of_points(0.09), 64);
  const MainLobe lobe = misfit::imager::main_lobe(psf);
  BOOST_TEST(lobe.samples.size() >= 30U);
  BOOST_TEST(lobe.scale == std::sqrt(static_cast<double>(lobe.samples.size()) / M_PI));
  for (const LobeSample& s : lobe.samples) {
    const auto row = 32 + std::lround(s.north * lobe.scale), column = 32 - std::lround(s.east * lobe.scale);
    BOOST_REQUIRE(s.value == psf.at(static_cast<int>(row), static_cast<int>(column)));
  }
}

BOOST_AUTO_TEST_CASE(an_open_lobe_is_its_pixels) {
  // A ridge one pixel wide, to the north-east: its pixels touch at their corners.
  Image psf(80, 80);
  for (int i = 1; i < 80; ++i) psf.at(i, 80 - i) = 1;
  const MainLobe lobe = misfit::imager::main_lobe(psf);
  BOOST_TEST(lobe.samples.size() == 1U);
  BOOST_TEST(lobe.samples.front().value == 1);
}

BOOST_AUTO_TEST_CASE(a_blank_pixel_counts_as_0) {
  Image psf = psf_of(square_of_points(0.3), 64);
  psf.at(3, 5) = 0;
  const MainLobe zero = misfit::imager::main_lobe(psf);
  psf.at(3, 5) = std::numeric_limits<double>::quiet_NaN();
  const MainLobe blank = misfit::imager::main_lobe(psf);
  BOOST_TEST(zero.samples.size() == blank.samples.size());
  for (std::size_t i = 0; i < zero.samples.size(); ++i) BOOST_REQUIRE(zero.samples[i].value == blank.samples[i].value);
}

BOOST_AUTO_TEST_SUITE_END()
