#include "imager/clean/auto_mask.h"

#include <boost/test/unit_test.hpp>
#include <limits>
#include <numeric>

#include "imager/clean/gaussian_blur.h"

BOOST_AUTO_TEST_SUITE(auto_mask)

using namespace misfit::imager;

namespace {

constexpr int side = 100;
const AutoMaskScene scene{.max_sidelobe = 0.01, .noise_jy = 1, .beam_fwhm_pixels = 4, .threads = 1};

/// A Gaussian of this peak and width.
Image source(int row, int column, double peak, double fwhm) {
  Image image(side, side);
  image.at(row, column) = 1;
  image = gaussian_blur(image, fwhm, 1);
  const double scale = peak / image.at(row, column);
  for (double& pixel : image.pixel) pixel *= scale;
  return image;
}

Image operator+(Image a, const Image& b) {
  for (std::size_t i = 0; i < a.pixel.size(); ++i) a.pixel[i] += b.pixel[i];
  return a;
}

Image mask_of(const Image& residual, const AutoMaskOptions& options = {}, const AutoMaskScene& of = scene) {
  Image mask(side, side);
  extend_mask(residual, options, of, mask);
  return mask;
}

double pixels(const Image& mask) {
  return std::accumulate(mask.pixel.begin(), mask.pixel.end(), 0.0);
}

}  // namespace

BOOST_AUTO_TEST_CASE(sources_above_the_noise_threshold_are_in_and_those_below_are_not) {
  const Image mask = mask_of(source(30, 40, 10, 4) + source(70, 20, 4.9, 4));
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(70, 20) == 0);
}

BOOST_AUTO_TEST_CASE(sources_below_the_sidelobes_of_the_brightest_are_not_in) {
  const Image sky = source(30, 40, 1000, 4) + source(70, 20, 29, 4);
  BOOST_TEST(mask_of(sky).at(30, 40) == 1);
  BOOST_TEST(mask_of(sky).at(70, 20) == 0);  // below 3 × 0.01 × 1000
  BOOST_TEST(mask_of(sky, {.sidelobe_threshold = 2}).at(70, 20) == 1);
}

BOOST_AUTO_TEST_CASE(what_is_smaller_than_a_part_of_the_beam_is_dropped) {
  Image sky = source(30, 40, 20, 4);
  sky.at(80, 80) = 20;  // a spike of noise
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(80, 80) == 0);
  BOOST_TEST(mask_of(sky, {.min_beam_fraction = 0}).at(80, 80) == 1);
}

BOOST_AUTO_TEST_CASE(a_region_reaches_about_a_beam_beyond_its_pixels) {
  Image sky(side, side);
  for (int r = 40; r < 60; ++r)
    for (int c = 40; c < 60; ++c) sky.at(r, c) = 10;
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(50, 40 - 3) == 1);
  BOOST_TEST(mask.at(50, 40 - 6) == 0);
}

BOOST_AUTO_TEST_CASE(what_was_in_stays_and_grows_into_the_faint) {
  const Image bright = source(50, 50, 10, 4), faint = source(50, 50, 4, 30);
  Image mask = mask_of(bright);
  const double before = pixels(mask);
  extend_mask(faint, {}, scene, mask);
  BOOST_TEST(mask.at(50, 60) == 1);  // above 1.5 σ, connected with what was in
  BOOST_TEST(pixels(mask) > 2 * before);
  Image apart = mask_of(source(5, 5, 10, 4));
  extend_mask(faint, {}, scene, apart);
  BOOST_TEST(apart.at(50, 50) == 0);  // not connected
  BOOST_TEST(apart.at(5, 5) == 1);
  Image slow = mask_of(bright);
  extend_mask(faint, {.grow_iterations = 2}, scene, slow);
  BOOST_TEST(slow.at(50, 60) == 0);
}

BOOST_AUTO_TEST_CASE(neither_nan_nor_negative_pixels_are_ever_in) {
  Image sky = source(30, 40, 20, 4) + source(70, 20, -20, 4);
  sky.at(30, 41) = std::numeric_limits<double>::quiet_NaN();
  const Image mask = mask_of(sky);
  BOOST_TEST(mask.at(30, 40) == 1);
  BOOST_TEST(mask.at(30, 41) == 0);
  BOOST_TEST(mask.at(70, 20) == 0);
}

BOOST_AUTO_TEST_CASE(noise_alone_leaves_the_mask_empty) {
  BOOST_TEST(pixels(mask_of(Image(side, side))) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
