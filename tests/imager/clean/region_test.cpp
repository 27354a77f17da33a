#include "imager/clean/region.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

BOOST_AUTO_TEST_SUITE(region)

using namespace misfit::imager;

namespace {

constexpr int width = 90, height = 70;

/// Pieces of all lengths, at the edges too: rows hold runs that begin and end at random.
Image scattered(unsigned seed, double part) {
  std::minstd_rand random(seed);
  std::bernoulli_distribution begins(part), ends(0.3);
  Image image(width, height);
  for (int r = 0; r < height; ++r)
    for (int c = 0, in = 0; c < width; ++c) {
      in = in != 0 ? !ends(random) : begins(random);
      image.at(r, c) = in;
    }
  return image;
}

}  // namespace

/// Cut far down, where the beam's whole reach counts; but for pixels that a rounding of 1e-9 of the cut could put in or out.
BOOST_AUTO_TEST_CASE(a_region_is_smoothed_as_an_image_is) {
  const Beam beams[] = {{5, 5, 0}, {9, 3, 0.6}, {3, 1.2, -1.1}, {40, 8, 1.4}};
  for (const Beam& beam : beams)
    for (const double part : {0.0005, 0.02, 0.4, 1.0})
      for (const double cut : {0.0, 1e-6, 0.01, 0.5})
        BOOST_TEST_CONTEXT("beam " << beam.major_rad << ", part " << part << ", cut " << cut) {
          const Image image = scattered(7, part), smooth = convolve_with_beam(image, beam, 1, 1);
          const double level = cut * *std::max_element(smooth.pixel.begin(), smooth.pixel.end());
          Region region(image, 1, [](double pixel) { return pixel != 0; });
          smooth_and_cut({beam, 1, cut, 2}, region);
          int unlike = 0;
          for (std::size_t i = 0; i < smooth.pixel.size(); ++i)
            if (cut == 0 || std::abs(smooth.pixel[i] - level) > 1e-9 * level)
              unlike += (smooth.pixel[i] > level) != (region.in[i] != 0);
          BOOST_TEST(unlike == 0);
        }
}

BOOST_AUTO_TEST_CASE(an_empty_region_stays_empty) {
  Region region(Image(width, height), 1, [](double pixel) { return pixel != 0; });
  smooth_and_cut({{5, 5, 0}, 1, 0.01, 1}, region);
  BOOST_TEST(region.empty());
}

BOOST_AUTO_TEST_SUITE_END()
