#include "tools/scene/truth.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "imager/data/noise.h"
#include "imager/data/stored_visibilities.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(truth)

using namespace misfit;
using namespace misfit::tools;

namespace {

constexpr double cell_rad = 1e-5;

imager::StoredVisibilities samples(double reach) {
  imager::StoredVisibilities stored;
  auto block = std::make_shared<imager::VisibilityBlock>(imager::testing::random_samples(100, 2, cell_rad, 1, reach));
  block->counts.samples_read = block->counts.used = block->samples();
  stored.append(std::move(block));
  return stored;
}

imager::ImageGeometry geometry() {
  imager::ImageGeometry image;
  image.width = 96;
  image.height = 64;
  image.cell_rad = cell_rad;
  return image;
}

SceneTruth truth_of(const imager::VisibilitySource& source, int pixels) {
  return {source, geometry(), pixels, 1, [](auto, auto) {}};
}

imager::Image direct_image(const imager::VisibilitySource& source) {
  return imager::make_dirty_images(source, imager::DirectTransform(geometry(), 1), imager::AdjointOptions{}, {}).dirty[0];
}

/// Errors that grow to its edges, most of them small.
imager::Image uneven_errors(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  imager::Image image(geometry().width, geometry().height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      image.at(row, column) = 1e-6 * std::pow(normal(random), 3) * (1 + std::abs(column - image.width / 2) / 8);
  return image;
}

imager::Image sum(imager::Image a, const imager::Image& b) {
  for (std::size_t i = 0; i < a.pixel.size(); ++i) a.pixel[i] += b.pixel[i];
  return a;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_error_is_that_of_the_whole_image_within_its_noise) {
  const imager::StoredVisibilities source = samples(0.99);
  const imager::Image exact = direct_image(source);
  double noise_before = 1;
  for (const int pixels : {64, 1024}) {
    const SceneTruth truth = truth_of(source, pixels);
    constexpr int images = 40;
    double square = 0, noise = 0;
    for (unsigned seed = 0; seed < images; ++seed) {
      const imager::Image error = uneven_errors(seed), spoilt = sum(exact, error);
      const double rms = imager::root_mean_square(error) / imager::root_mean_square(spoilt);
      const SceneErrors found = truth.errors_of(spoilt);
      square += std::pow((found.rms / rms - 1) / found.rms_noise, 2);
      noise += found.rms_noise / images;
    }
    BOOST_TEST(noise < noise_before / 2);  // a quarter, were not large errors rare
    noise_before = noise;
    // 1, but for forty draws, and for errors of which few pixels hold most.
    BOOST_TEST(std::sqrt(square / images) > 0.5);
    BOOST_TEST(std::sqrt(square / images) < 2);
  }
}

BOOST_AUTO_TEST_CASE(errors_at_the_border_count_as_its_part_of_the_image) {
  const imager::StoredVisibilities source = samples(0.99);
  imager::Image error(geometry().width, geometry().height);
  for (int row = 0; row < error.height; ++row)
    for (int column = 0; column < error.width; ++column)
      error.at(row, column) = row < 4 || row >= 60 || column < 6 || column >= 90 ? 1e-3 : 0;
  const imager::Image spoilt = sum(direct_image(source), error);
  const SceneErrors found = truth_of(source, 20).errors_of(spoilt);
  const double image_rms = imager::root_mean_square(spoilt);
  BOOST_TEST(found.centre_rms < 1e-12);
  BOOST_TEST(found.border_rms == 1e-3 / image_rms, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found.border_max == 1e-3 / image_rms, boost::test_tools::tolerance(1e-9));
  BOOST_TEST(found.rms == imager::root_mean_square(error) / image_rms, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(an_error_of_equal_pixels_is_known_without_noise) {
  const imager::StoredVisibilities source = samples(0.99);
  imager::Image image = direct_image(source);
  for (double& pixel : image.pixel) pixel += 1e-3;
  const SceneErrors errors = truth_of(source, 128).errors_of(image);
  BOOST_TEST(errors.rms == 1e-3 / imager::root_mean_square(image), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(errors.rms_noise < 1e-6);
}

BOOST_AUTO_TEST_CASE(samples_beyond_the_grid_are_counted) {
  BOOST_TEST(truth_of(samples(0.99), 1).counts().outside_grid == 0U);
  const SceneTruth truth = truth_of(samples(2), 1);
  const imager::SampleCounts& counts = truth.counts();
  BOOST_TEST(counts.outside_grid > 0U);
  BOOST_TEST(counts.used + counts.outside_grid == 200U);
  BOOST_CHECK_THROW(truth_of(samples(1e6), 1), imager::NothingUsable);
}

BOOST_AUTO_TEST_SUITE_END()
