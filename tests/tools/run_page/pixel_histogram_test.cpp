#include "tools/run_page/pixel_histogram.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "imager/data/noise.h"

BOOST_AUTO_TEST_SUITE(pixel_histogram)

using namespace misfit;
using misfit::tools::histogram_figure;
using misfit::tools::histogram_json;
using misfit::tools::PixelHistogram;

namespace {

imager::Image gaussian_noise(double sigma, unsigned seed) {
  imager::Image image(300, 400);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, sigma);
  for (double& pixel : image.pixel) pixel = normal(random);
  return image;
}

std::uint64_t counted(const PixelHistogram& histogram) {
  return std::accumulate(histogram.count.begin(), histogram.count.end(), std::uint64_t{0});
}

}  // namespace

BOOST_AUTO_TEST_CASE(noise_follows_the_gaussian_drawn_over_it) {
  const imager::Image image = gaussian_noise(3e-4, 1);
  const PixelHistogram histogram = tools::pixel_histogram(image, imager::robust_noise(image), 2);
  const tools::Figure figure = histogram_figure(histogram);
  BOOST_TEST(counted(histogram) == image.pixel.size());
  for (std::size_t i = 0; i < histogram.count.size(); ++i) {
    BOOST_TEST(figure.series[0].x[i] == figure.series[1].x[i]);
    const double expected = figure.series[1].y[i];
    // Counts scatter by their square root; the σ found by 0.3 %, the width of a bin by its curvature: 2 % of a bin.
    if (expected > 20) BOOST_TEST(std::abs(figure.series[0].y[i] - expected) < 5 * std::sqrt(expected) + 0.02 * expected, i);
  }
}

BOOST_AUTO_TEST_CASE(every_finite_pixel_lies_in_the_bin_of_its_value) {
  imager::Image image(5, 2);
  const double not_there = std::numeric_limits<double>::quiet_NaN();
  image.pixel = {0.1, 0.3, -0.1, -6.9, 6.9, 6.95, not_there, not_there, 5.1, -4.9};
  const PixelHistogram histogram = tools::pixel_histogram(image, 1, 1);
  BOOST_TEST(histogram.pixels == 8U);
  BOOST_TEST(histogram.beyond_5_sigma == 4U);
  BOOST_TEST(histogram.min_jy == -6.9);
  BOOST_TEST(histogram.max_jy == 6.95);
  const std::size_t middle = histogram.count.size() / 2;
  BOOST_TEST(static_cast<double>(middle) * histogram.step_sigma == 7.0);
  BOOST_TEST(counted(histogram) == 8U);
  BOOST_TEST(histogram.count[middle] == 1U);
  BOOST_TEST(histogram.count[middle + 1] == 1U);
  BOOST_TEST(histogram.count[middle - 1] == 1U);
  BOOST_TEST(histogram.count.front() == 1U);
  BOOST_TEST(histogram.count.back() == 2U);
}

BOOST_AUTO_TEST_CASE(bright_sources_are_told_of_and_do_not_stretch_the_axis) {
  imager::Image image = gaussian_noise(1, 2);
  image.at(7, 8) = 1e6;
  image.at(8, 8) = -50;
  const PixelHistogram histogram = tools::pixel_histogram(image, 1, 2);
  BOOST_TEST(static_cast<double>(histogram.count.size()) * histogram.step_sigma == 20.0);
  BOOST_TEST(histogram.pixels == image.pixel.size());
  BOOST_TEST(counted(histogram) == image.pixel.size() - 2);
  BOOST_TEST(histogram.beyond_5_sigma == 2U);
  BOOST_TEST(histogram.max_jy == 1e6);
}

BOOST_AUTO_TEST_CASE(any_number_of_threads_counts_the_same) {
  const imager::Image image = gaussian_noise(1, 3);
  const auto once = histogram_json(tools::pixel_histogram(image, 1, 1));
  BOOST_TEST(histogram_json(tools::pixel_histogram(image, 1, 5)) == once);
}

BOOST_AUTO_TEST_CASE(an_image_without_noise_has_none) {
  const PixelHistogram histogram = tools::pixel_histogram(imager::Image(10, 10), 0, 1);
  BOOST_TEST(histogram.pixels == 0U);
  BOOST_TEST(histogram_json(histogram).is_null());
}

BOOST_AUTO_TEST_SUITE_END()
