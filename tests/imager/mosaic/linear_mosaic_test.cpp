#include "imager/mosaic/linear_mosaic.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

BOOST_AUTO_TEST_SUITE(linear_mosaic)

using namespace misfit::imager;

namespace {

constexpr int width = 37, height = 29, pointings = 4;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Pointing {
  Image apparent, beam;
  double noise_jy;
};

/// Gaussian beams on a line, with noises that differ, a hole in each image, and beams that end.
std::vector<Pointing> example() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<Pointing> all;
  for (int p = 0; p < pointings; ++p) {
    Pointing one{Image(width, height), Image(width, height), 0.1 * (1 + p)};
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const double x = c - 8.0 * p - 5, y = r - 14.0, beam = std::exp(-(x * x + y * y) / 90);
        one.beam.at(r, c) = beam < 0.02 ? none : beam;
        one.apparent.at(r, c) = std::abs(c - 9 * p) + std::abs(r - 10) < 3 ? none : normal(random);
      }
    all.push_back(std::move(one));
  }
  return all;
}

MosaicPlane mosaic_of(const std::vector<Pointing>& all, double limit, int threads) {
  LinearMosaic mosaic(width, height);
  for (const Pointing& one : all) mosaic.add({one.apparent, one.beam, one.noise_jy}, threads);
  return mosaic.finished(limit);
}

bool alike(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 1e-13 * std::abs(b);
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_its_definition_pixel_by_pixel) {
  constexpr double limit = 0.3;
  const std::vector<Pointing> all = example();
  const MosaicPlane mosaic = mosaic_of(all, limit, 3);
  const auto weight_at = [&](std::size_t i, auto numerator) {
    double sum = 0;
    for (const Pointing& p : all) {
      const double b = p.beam.pixel[i], d = p.apparent.pixel[i];
      if (b >= LinearMosaic::least_beam && !std::isnan(d)) sum += b * numerator(b, d) / (p.noise_jy * p.noise_jy);
    }
    return sum;
  };
  std::vector<double> weight(mosaic.sky.pixel.size());
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = weight_at(i, [](double b, double) { return b; });
  const double most = *std::max_element(weight.begin(), weight.end());
  int defined = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const bool known = std::sqrt(weight[i] / most) >= limit;
    defined += known ? 1 : 0;
    BOOST_TEST(alike(mosaic.sky.pixel[i], known ? weight_at(i, [](double, double d) { return d; }) / weight[i] : none));
    BOOST_TEST(alike(mosaic.weight.pixel[i], known ? weight[i] : none));
    BOOST_TEST(alike(mosaic.noise.pixel[i], known ? 1 / std::sqrt(weight[i]) : none));
    BOOST_TEST(alike(mosaic.beam.pixel[i], known ? std::sqrt(weight[i] / most) : none));
  }
  BOOST_TEST(defined > 200);
  BOOST_TEST(defined < width * height - 200);
}

BOOST_AUTO_TEST_CASE(one_sky_in_all_images_is_that_sky) {
  std::vector<Pointing> all = example();
  for (Pointing& one : all)
    for (std::size_t i = 0; i < one.beam.pixel.size(); ++i)
      one.apparent.pixel[i] = one.beam.pixel[i] * std::sin(static_cast<double>(i));
  const MosaicPlane mosaic = mosaic_of(all, 0.01, 1);
  for (std::size_t i = 0; i < mosaic.sky.pixel.size(); ++i)
    if (!std::isnan(mosaic.sky.pixel[i])) BOOST_TEST(std::abs(mosaic.sky.pixel[i] - std::sin(static_cast<double>(i))) < 1e-14);
}

BOOST_AUTO_TEST_CASE(any_number_of_threads_gives_the_same_bits) {
  const std::vector<Pointing> all = example();
  const MosaicPlane one = mosaic_of(all, 0.2, 1), three = mosaic_of(all, 0.2, 3);
  for (std::size_t i = 0; i < one.sky.pixel.size(); ++i)
    BOOST_TEST((one.sky.pixel[i] == three.sky.pixel[i] || (std::isnan(one.sky.pixel[i]) && std::isnan(three.sky.pixel[i]))));
}

BOOST_AUTO_TEST_CASE(nothing_makes_nothing) {
  for (const double pixel : LinearMosaic(3, 2).finished(0.2).sky.pixel) BOOST_TEST(std::isnan(pixel));
}

BOOST_AUTO_TEST_CASE(parts_that_do_not_fit_are_refused) {
  LinearMosaic mosaic(3, 2);
  const Image fits(3, 2), other(2, 3);
  BOOST_CHECK_THROW(mosaic.add({fits, fits, 0}, 1), std::invalid_argument);
  BOOST_CHECK_THROW(mosaic.add({fits, fits, none}, 1), std::invalid_argument);
  BOOST_CHECK_THROW(mosaic.add({other, fits, 1}, 1), std::invalid_argument);
  BOOST_CHECK_THROW(mosaic.add({fits, other, 1}, 1), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
