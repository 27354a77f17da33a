#include "imager/mosaic/band_limited_image.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(band_limited_image)

using namespace misfit::imager;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A wave in a Gaussian window of standard deviation `width`, pixels: its spectrum is within 6/(2π width) of its frequency.
struct Packet {
  static constexpr double width = 10;
  double column, row, amplitude, u, v, phase;

  double at(double x, double y) const {
    const double dx = x - column, dy = y - row;
    return amplitude * std::exp(-(dx * dx + dy * dy) / (2 * width * width)) * std::cos(2 * pi * (u * dx + v * dy) + phase);
  }
};

/// A function with a random spectrum up to 0.4 cycles a pixel along each axis, which ends before an image of `size` pixels
/// does.
class RandomFunction {
 public:
  RandomFunction(int size, unsigned seed) {
    std::mt19937 random(seed);
    const double apart = 7 * Packet::width, reach = 0.4 - 6 / (2 * pi * Packet::width);
    std::uniform_real_distribution<double> place(apart, size - apart), frequency(-reach, reach), phase(0, 2 * pi), one(-1, 1);
    for (int k = 0; k < 40; ++k)
      packets_.push_back({place(random), place(random), one(random), frequency(random), frequency(random), phase(random)});
  }
  double at(double column, double row) const {
    double sum = 0;
    for (const Packet& packet : packets_) sum += packet.at(column, row);
    return sum;
  }
  Image pixels(int width, int height) const {
    Image image(width, height);
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) image.at(r, c) = at(c, r);
    return image;
  }

 private:
  std::vector<Packet> packets_;
};

Image noise(int width, int height) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  Image image(width, height);
  for (double& pixel : image.pixel) pixel = normal(random);
  return image;
}

}  // namespace

/// The degridding function errs by 9e-8 (RMS) along each axis, 1.3e-7 along both, and pixels of the fine plane are rounded to
/// 6e-8.
BOOST_AUTO_TEST_CASE(functions_without_frequencies_above_the_pass_band_are_interpolated_exactly) {
  constexpr int size = 240, places = 3000;
  const RandomFunction function(size, 1);
  const Image pixels = function.pixels(size + 7, size);  // sides that differ, one of them odd
  const BandLimitedImage image(pixels, pixels, 2);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(BandLimitedImage::margin, size - 1 - BandLimitedImage::margin);
  double squares = 0, error_squares = 0, largest = 0;
  for (int k = 0; k < places; ++k) {
    const PixelPlace at{place(random), place(random)};
    const double exact = function.at(at.column, at.row), error = image.at(at) - exact;
    squares += exact * exact;
    error_squares += error * error;
    largest = std::max(largest, std::abs(error));
  }
  BOOST_TEST_MESSAGE("RMS " << std::sqrt(error_squares / squares) << ", largest " << largest / std::sqrt(squares / places));
  BOOST_TEST(std::sqrt(error_squares / squares) < 3e-7);
  BOOST_TEST(largest < 5e-6 * std::sqrt(squares / places));
}

/// g(½ + t) + g(½ − t) = 1 makes it so, be the spectrum what it may.
BOOST_AUTO_TEST_CASE(pixels_keep_their_values) {
  const Image pixels = noise(71, 60);
  const BandLimitedImage image(pixels, pixels, 1);
  double largest = 0;
  for (int r = BandLimitedImage::margin; r < 60 - BandLimitedImage::margin; ++r)
    for (int c = BandLimitedImage::margin; c < 71 - BandLimitedImage::margin; ++c)
      largest = std::max(largest, std::abs(image.at({double(c), double(r)}) - pixels.at(r, c)));
  BOOST_TEST(largest < 5e-6);  // of unit noise
}

BOOST_AUTO_TEST_CASE(places_near_unknown_pixels_and_borders_are_undefined) {
  constexpr int margin = BandLimitedImage::margin;
  Image pixels = noise(80, 64);
  pixels.at(30, 40) = none;
  Image shown = pixels;
  shown.at(20, 20) = none;
  const BandLimitedImage image(pixels, shown, 2);
  const auto defined = [&](double column, double row) { return !std::isnan(image.at({column, row})); };
  for (const double side : {-1.0, 1.0}) {
    BOOST_TEST(!defined(40 + side * margin, 30));
    BOOST_TEST(!defined(40, 30 + side * margin));
    BOOST_TEST(!defined(40 + side * margin, 30 - side * margin));
    BOOST_TEST(defined(40 + side * (margin + 1), 30));
    BOOST_TEST(defined(40, 30 + side * (margin + 1)));
    BOOST_TEST(!defined(20 + side * 0.4, 20));  // which is only not shown
    BOOST_TEST(defined(20 + side, 20));
  }
  BOOST_TEST(!defined(margin - 0.6, 20));
  BOOST_TEST(defined(margin, 50));
  BOOST_TEST(defined(80 - margin - 1, 50));
  BOOST_TEST(!defined(80 - margin, 50));
  BOOST_TEST(!defined(60, margin - 1));
  BOOST_TEST(!defined(60, 64 - margin));
  BOOST_TEST(!defined(none, 30));
  BOOST_TEST(!defined(-1e300, 30));
}

/// Another number there, or beyond the border, changes what is defined by little.
BOOST_AUTO_TEST_CASE(unknown_pixels_do_not_reach_beyond_the_margin) {
  Image pixels(128, 64), hidden;
  for (int r = 0; r < 64; ++r)
    for (int c = 0; c < 128; ++c) pixels.at(r, c) = std::cos(2 * pi * 0.3 * c);
  hidden = pixels;
  for (int r = 0; r < 64; ++r)
    for (int c = 0; c < 40; ++c) hidden.at(r, c) = none;
  const BandLimitedImage whole(pixels, pixels, 1), part(hidden, hidden, 1);
  double largest = 0;
  for (double x = 48.01; x < 100; x += 0.17) {
    BOOST_REQUIRE(!std::isnan(part.at({x, 30})));
    largest = std::max(largest, std::abs(whole.at({x, 30}) - part.at({x, 30})));
  }
  BOOST_TEST(largest < 0.01);
}

BOOST_AUTO_TEST_CASE(small_images_are_undefined_everywhere) {
  const Image pixels = noise(2 * BandLimitedImage::margin, 40);
  const BandLimitedImage image(pixels, pixels, 1);
  BOOST_TEST(std::isnan(image.at({8, 20})));
}

BOOST_AUTO_TEST_CASE(any_number_of_threads_gives_the_same_bits) {
  const Image pixels = noise(90, 77);
  const ImageGeometry own{90, 77, 1e-5, {1, 0.5, "FK5"}}, other{60, 50, 1.3e-5, {1, 0.5, "FK5"}, {1e-6, 2e-6}};
  const GridMap map(other, grid_of(own));
  const Image one = regridded(BandLimitedImage(pixels, pixels, 1), map, Image(60, 50), 1);
  const Image three = regridded(BandLimitedImage(pixels, pixels, 3), map, Image(60, 50), 3);
  int defined = 0;
  for (std::size_t i = 0; i < one.pixel.size(); ++i) {
    BOOST_TEST((one.pixel[i] == three.pixel[i] || (std::isnan(one.pixel[i]) && std::isnan(three.pixel[i]))));
    defined += std::isnan(one.pixel[i]) ? 0 : 1;
  }
  BOOST_TEST(defined > 1000);
}

BOOST_AUTO_TEST_CASE(masks_of_another_size_are_refused) {
  BOOST_CHECK_THROW(BandLimitedImage(Image(40, 40), Image(40, 41), 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
