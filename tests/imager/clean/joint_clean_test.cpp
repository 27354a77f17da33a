#include "imager/clean/joint_clean.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <map>
#include <numeric>

#include "imager/clean/bright_loops.h"
#include "imager/data/noise.h"
#include "tests/imager/clean/convolution.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(joint_clean)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// 1 at the centre pixel, random sidelobes elsewhere.
Image random_psf(int width, int height, double sidelobes) {
  Image psf = random_image(width, height, 99);
  for (double& pixel : psf.pixel) pixel *= sidelobes;
  psf.at(height / 2, width / 2) = 1;
  return psf;
}

struct Cleaned {
  int iterations = 0;
  double peak_jy = 0;
  Image model;
};

Cleaned cleaned(const Image& residual, const Image& psf, const MinorCycleOptions& options, int threads = 3) {
  const MinorCycleReport report = JointClean({&psf}, {.threads = threads}).clean(residual, options);
  Cleaned result{report.iterations(), report.peak_jy, Image(residual.width, residual.height)};
  for (const Component& c : report.components) result.model.at(c.row, c.column) += c.flux_jy;
  return result;
}

/// The definition, in double precision.
Cleaned plain(Image residual, const Image& psf, const MinorCycleOptions& options) {
  Cleaned result{0, 0, Image(residual.width, residual.height)};
  while (true) {
    const Peak peak = find_peak(residual);
    result.peak_jy = std::abs(peak.value);
    if (result.iterations == options.max_iterations || result.peak_jy <= options.threshold_jy) return result;
    const double component = options.gain * peak.value;
    result.model.at(peak.row, peak.column) += component;
    ++result.iterations;
    for (int r = 0; r < residual.height; ++r)
      for (int c = 0; c < residual.width; ++c) {
        const int psf_row = r - peak.row + psf.height / 2, psf_column = c - peak.column + psf.width / 2;
        if (psf_row >= 0 && psf_row < psf.height && psf_column >= 0 && psf_column < psf.width)
          residual.at(r, c) -= component * psf.at(psf_row, psf_column);
      }
  }
}

}  // namespace

/// As long as no pixel that was faint becomes the brightest.
BOOST_DATA_TEST_CASE(components_are_those_of_the_plain_double_loop,
                     bdata::make({1, 2, 7, 16, 33, 40}) ^ bdata::make({1, 5, 1, 16, 21, 150}), width, height) {
  const Image residual = random_image(width, height, 1), psf = random_psf(width, height, 0.02);
  for (const double gain : {0.1, 0.5, 1.0}) {
    const MinorCycleOptions options{.gain = gain, .max_iterations = 100, .threshold_jy = 0.3, .stop_requested = {}};
    const Cleaned is = cleaned(residual, psf, options), should = plain(residual, psf, options);
    BOOST_TEST(is.iterations == should.iterations);
    // Single precision: each of 100 subtractions rounds by 6e-8 of a value near 1.
    BOOST_TEST(distance(is.model.pixel, should.model.pixel) <= 1e-5 * norm(should.model.pixel));
    BOOST_TEST(std::abs(is.peak_jy - should.peak_jy) < 1e-5);
  }
}

/// Images of many tiles, few of which are looked at for most components.
BOOST_DATA_TEST_CASE(components_of_large_images_are_those_of_the_plain_double_loop, bdata::make({0.02, 0.003, 0.0}),
                     sidelobes) {
  const Image residual = random_image(250, 210, 4), psf = random_psf(250, 210, sidelobes);
  const MinorCycleOptions options{.gain = 0.2, .max_iterations = 1500, .threshold_jy = 0.1, .stop_requested = {}};
  const Cleaned is = cleaned(residual, psf, options), should = plain(residual, psf, options);
  BOOST_TEST(is.iterations == should.iterations);
  BOOST_TEST(distance(is.model.pixel, should.model.pixel) <= 1e-5 * norm(should.model.pixel));
  BOOST_TEST(std::abs(is.peak_jy - should.peak_jy) < 1e-5);
}

/// A faint background, parts of which sidelobes make bright.
Image bright_sources_on_faint_noise(int width, int height) {
  Image image = random_image(width, height, 6);
  for (double& pixel : image.pixel) pixel *= 0.05;
  for (int i = 0; i < 8; ++i) image.at((37 * i + 5) % height, (61 * i + 9) % width) += 10 - 0.1 * i;
  return image;
}

/// Many sources and noise, seen with sidelobes that reach beyond near tiles.
Image crowded_field(const Image& psf) {
  Image sky(psf.width, psf.height);
  for (int i = 0; i < 300; ++i) sky.at((7919 * i + 13) % psf.height, (104729 * i + 7) % psf.width) += 10.0 / (1 + i);
  Image image = Convolution<double>(psf, 2)(sky);
  const Image noise = random_image(psf.width, psf.height, 6);
  for (std::size_t i = 0; i < noise.pixel.size(); ++i) image.pixel[i] += 0.01 * noise.pixel[i];
  return image;
}

double flux_of(const Cleaned& cleaned) {
  return std::accumulate(cleaned.model.pixel.begin(), cleaned.model.pixel.end(), 0.0);
}

Image left_by(const Cleaned& cleaned, Image residual, const Image& psf) {
  subtract(Convolution<double>(psf, 2)(cleaned.model), residual);
  return residual;
}

/// Not the same components in the same order, since faint pixels are looked at only in the end, and far ones now and then; but
/// as few, of as much flux, and no less is left.
BOOST_DATA_TEST_CASE(a_crowded_field_is_cleaned_as_well_as_by_the_plain_double_loop, bdata::make({0.1, 0.4}), gain) {
  const Image psf = random_psf(700, 640, 0.003), residual = crowded_field(psf);
  const MinorCycleOptions options{.gain = gain, .max_iterations = 100000, .threshold_jy = 0.05, .stop_requested = {}};
  const Cleaned is = cleaned(residual, psf, options), should = plain(residual, psf, options);
  BOOST_TEST(std::abs(is.iterations / double(should.iterations) - 1) < 0.02);
  BOOST_TEST(std::abs(flux_of(is) / flux_of(should) - 1) < 2e-3);
  BOOST_TEST(largest_magnitude(left_by(is, residual, psf)) <= 1.005 * options.threshold_jy + 1e-5);
  BOOST_TEST(robust_noise(left_by(is, residual, psf)) <= 1.001 * robust_noise(left_by(should, residual, psf)));
  // Where there are few sources, those of the plain loop are found.
  double apart = 0;
  for (std::size_t i = 0; i < is.model.pixel.size(); ++i)
    if (should.model.pixel[i] > 0.2) apart = std::max(apart, std::abs(is.model.pixel[i] - should.model.pixel[i]));
  BOOST_TEST(apart < 0.01);
}

BOOST_AUTO_TEST_CASE(pixels_below_its_view_are_left_only_where_that_is_enough) {
  const Image psf = random_psf(700, 640, 0.02), residual = crowded_field(psf);
  MinorCycleOptions options{.gain = 0.1, .max_iterations = 100000, .threshold_jy = 0.2, .stop_requested = {}};
  options.to_the_last = false;
  const Cleaned some = cleaned(residual, psf, options);
  BOOST_TEST(some.peak_jy <= options.threshold_jy);
  options.to_the_last = true;
  const Cleaned all = cleaned(residual, psf, options);
  BOOST_TEST(std::abs(all.peak_jy - largest_magnitude(left_by(all, residual, psf))) < 1e-5);
  BOOST_TEST(some.iterations <= all.iterations);
}

/// Sidelobes that are brighter than the noise under them pass for it until their sources are gone.
BOOST_AUTO_TEST_CASE(it_goes_as_deep_as_the_noise_of_what_is_left_lets_it) {
  const Image psf = random_psf(700, 640, 0.02), residual = crowded_field(psf);
  const double before = robust_noise(residual), nsigma = 5;
  MinorCycleOptions options{
      .gain = 0.1, .max_iterations = 100000, .nsigma = nsigma, .noise_jy = before, .to_the_last = false, .stop_requested = {}};
  const MinorCycleReport report = JointClean({&psf}, {.threads = 2}).clean(residual, options);
  Cleaned is{report.iterations(), report.peak_jy, Image(700, 640)};
  for (const Component& c : report.components) is.model.at(c.row, c.column) += c.flux_jy;
  const double left = robust_noise(left_by(is, residual, psf));
  BOOST_TEST(left < 0.5 * before);
  // Noise that has fallen by 2 % or less is not followed.
  BOOST_TEST(report.depth_jy > 0.99 * nsigma * left);
  BOOST_TEST(report.depth_jy < 1.03 * nsigma * left);
  BOOST_TEST(report.peak_jy <= 1.005 * report.depth_jy);

  // What a mask hides, its sidelobes and noise, is not seen to fall.
  Image mask(700, 640);
  std::fill(mask.pixel.begin(), mask.pixel.end(), 1);
  options.mask = &mask;
  BOOST_TEST(JointClean({&psf}, {.threads = 2}).clean(residual, options).depth_jy == nsigma * before);
}

/// Σ |flux| of components in each square of bright_tile_side pixels.
std::map<std::pair<int, int>, double> flux_by_square(const std::vector<Component>& components) {
  std::map<std::pair<int, int>, double> flux;
  for (const Component& c : components) flux[{c.row / bright_tile_side, c.column / bright_tile_side}] += std::abs(c.flux_jy);
  return flux;
}

/// Doubtful sidelobes by their RMS alone, by the largest, and both.
BOOST_DATA_TEST_CASE(it_goes_as_deep_as_doubts_about_what_it_found_allow,
                     bdata::make({0.0, 0.005, 0.01, 0.02, 100.0, 0.0, 0.0, 0.01}) ^
                         bdata::make({0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.2}),
                     rms, largest) {
  const Image psf = random_psf(700, 640, 0.003), residual = crowded_field(psf);
  const double threshold = 0.05, sure = 0.3;
  const MinorCycleReport report = JointClean({&psf}, {.threads = 2})
                                      .clean(residual, {.gain = 0.1,
                                                        .max_iterations = 100000,
                                                        .threshold_jy = threshold,
                                                        .doubtful = {rms, largest},
                                                        .sure_jy = sure,
                                                        .to_the_last = false,
                                                        .stop_requested = {}});
  double squares = 0, most = 0;
  for (const auto& [square, flux] : flux_by_square(report.components)) squares += flux * flux, most = std::max(most, flux);
  const double doubted = std::max(rms * std::sqrt(squares), largest * most);
  BOOST_TEST(report.depth_jy == std::clamp(doubted, threshold, sure), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(report.peak_jy <= report.depth_jy);
  // One component takes a tenth of a peak that was above its depth.
  BOOST_TEST(report.peak_jy >= 0.85 * report.depth_jy);
  BOOST_TEST((report.end == MinorCycleEnd::threshold));
}

BOOST_AUTO_TEST_CASE(the_result_is_the_same_bit_for_bit_for_any_number_of_threads) {
  const Image residual = bright_sources_on_faint_noise(250, 210), psf = random_psf(250, 210, 0.003);
  const MinorCycleOptions options{.gain = 0.02, .max_iterations = 3000, .threshold_jy = 0, .stop_requested = {}};
  const Cleaned one = cleaned(residual, psf, options, 1);
  for (const int threads : {2, 3, 6, 50}) {
    const Cleaned many = cleaned(residual, psf, options, threads);
    BOOST_TEST((many.model.pixel == one.model.pixel));
    BOOST_TEST(many.peak_jy == one.peak_jy);
  }
}

BOOST_DATA_TEST_CASE(pixels_that_are_nan_are_never_cleaned_and_change_nothing,
                     bdata::make({1, 7, 40, 40}) ^ bdata::make({5, 2, 33, 150}), width, height) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Image residual = random_image(width, height, 1), psf = random_psf(width, height, 0.05), zeroed = psf;
  for (std::size_t i = 0; i < residual.pixel.size(); i += 3) residual.pixel[i] = nan;
  for (int c = 0; c < width; ++c) residual.at(0, c) = nan;
  const std::size_t peak =
      static_cast<std::size_t>(height / 2) * static_cast<std::size_t>(width) + static_cast<std::size_t>(width / 2);
  for (std::size_t i = 0; i < psf.pixel.size(); i += 5)
    if (i != peak) psf.pixel[i] = nan, zeroed.pixel[i] = 0;
  const MinorCycleOptions options{.gain = 0.3, .max_iterations = 100, .threshold_jy = 0.3, .stop_requested = {}};
  const Cleaned is = cleaned(residual, psf, options), should = plain(residual, zeroed, options);
  BOOST_TEST(is.iterations == should.iterations);
  BOOST_TEST(distance(is.model.pixel, should.model.pixel) <= 1e-5 * norm(should.model.pixel));
  BOOST_TEST(std::abs(is.peak_jy - should.peak_jy) < 1e-5);
  for (std::size_t i = 0; i < residual.pixel.size(); ++i)
    if (std::isnan(residual.pixel[i])) BOOST_REQUIRE(is.model.pixel[i] == 0);
}

BOOST_AUTO_TEST_CASE(an_image_of_nan_has_nothing_to_clean) {
  Image residual(9, 7);
  std::fill(residual.pixel.begin(), residual.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  const Cleaned is = cleaned(residual, random_psf(9, 7, 0.1), {.max_iterations = 10, .stop_requested = {}});
  BOOST_TEST(is.iterations == 0);
  BOOST_TEST(is.peak_jy == 0);
  BOOST_TEST(norm(is.model.pixel) == 0);
}

BOOST_AUTO_TEST_CASE(an_image_of_zeros_has_nothing_to_clean) {
  const Cleaned is = cleaned(Image(9, 7), random_psf(9, 7, 0.1), {.max_iterations = 10, .stop_requested = {}});
  BOOST_TEST(is.iterations == 0);
  BOOST_TEST(is.peak_jy == 0);
  BOOST_TEST(norm(is.model.pixel) == 0);
}

BOOST_AUTO_TEST_CASE(a_single_pixel_loses_gain_times_its_value_each_time) {
  Image residual(1, 1), psf(1, 1);
  residual.at(0, 0) = 2;
  psf.at(0, 0) = 1;
  const Cleaned is = cleaned(residual, psf, {.gain = 0.25, .max_iterations = 3, .stop_requested = {}});
  BOOST_TEST(is.peak_jy == 2 * 0.75 * 0.75 * 0.75);
  BOOST_TEST(is.model.at(0, 0) == 2 - is.peak_jy);
}

BOOST_AUTO_TEST_CASE(a_negative_peak_becomes_a_negative_component) {
  Image residual(8, 8);
  residual.at(2, 5) = -4;
  residual.at(6, 1) = 3;
  const Cleaned is = cleaned(residual, random_psf(8, 8, 0), {.gain = 0.5, .max_iterations = 1, .stop_requested = {}});
  BOOST_TEST(is.model.at(2, 5) == -2);
  BOOST_TEST(is.peak_jy == 3);
}

BOOST_AUTO_TEST_CASE(gain_one_takes_isolated_sources_at_once) {
  Image sky(30, 20);
  sky.at(0, 0) = 1;
  sky.at(19, 29) = -2;
  sky.at(7, 13) = 3;
  const Cleaned is =
      cleaned(sky, random_psf(30, 20, 0), {.gain = 1, .max_iterations = 10, .threshold_jy = 1e-5, .stop_requested = {}});
  BOOST_TEST(is.iterations == 3);
  BOOST_TEST((is.model.pixel == sky.pixel));
}

BOOST_AUTO_TEST_CASE(a_threshold_at_or_above_the_peak_leaves_everything) {
  Image residual(5, 5);
  residual.at(1, 1) = 0.5;
  for (const double threshold : {0.5, 0.6}) {
    const MinorCycleOptions options{.max_iterations = 10, .threshold_jy = threshold, .stop_requested = {}};
    const Cleaned is = cleaned(residual, random_psf(5, 5, 0), options);
    BOOST_TEST(is.iterations == 0);
    BOOST_TEST(is.peak_jy == 0.5);
  }
}

BOOST_AUTO_TEST_CASE(the_user_can_stop_it) {
  const MinorCycleOptions options{.max_iterations = 1000000, .stop_requested = [] { return true; }};
  const Cleaned is = cleaned(random_image(8, 8, 3), random_psf(8, 8, 0), options);
  BOOST_TEST(is.iterations == 0);
}

BOOST_AUTO_TEST_SUITE_END()
