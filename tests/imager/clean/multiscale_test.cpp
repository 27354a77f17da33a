#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <limits>

#include "imager/clean/gaussian_blur.h"
#include "imager/clean/joint_clean.h"
#include "imager/data/noise.h"
#include "tests/imager/clean/convolution.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(multiscale)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int side = 256;
constexpr double beam_pixels = 4;

/// A Gaussian beam in a bowl, as an array without short baselines has it: nothing wider than 25 beams is seen.
Image psf() {
  Image point(side, side);
  point.at(side / 2, side / 2) = 1;
  Image beam = gaussian_blur(point, beam_pixels, 2);
  subtract(gaussian_blur(point, 25 * beam_pixels, 2), beam);
  const double peak = beam.at(side / 2, side / 2);
  for (double& pixel : beam.pixel) pixel /= peak;
  return beam;
}

Image observed(const Image& sky, const Image& beam, double noise_jy) {
  Image noise = gaussian_blur(random_image(side, side, 11), beam_pixels, 2);
  const double scale = noise_jy / robust_noise(noise);
  Image dirty = Convolution<double>(beam, 2)(sky);
  for (std::size_t i = 0; i < dirty.pixel.size(); ++i) dirty.pixel[i] += scale * noise.pixel[i];
  return dirty;
}

}  // namespace

/// Flux within 2 %, no bowl below −3 σ.
BOOST_AUTO_TEST_CASE(a_gaussian_of_ten_beams_keeps_its_flux_and_leaves_no_bowl) {
  constexpr double noise = 1e-3, flux = 10;
  Image sky(side, side);
  sky.at(125, 131) = flux;
  sky = gaussian_blur(sky, 10 * beam_pixels, 2);
  const Image beam = psf(), dirty = observed(sky, beam, noise);
  const JointClean minor({&beam}, {.scale_pixels = {0, 6, 15, 35}, .small_scale_bias = 0, .threads = 2});
  const MinorCycleReport report =
      minor.clean(dirty, {.gain = 0.1, .max_iterations = 5000, .threshold_jy = 4 * noise, .stop_requested = {}});
  ComponentModel model(side, side, minor.scale_pixels());
  model.add(report.components);
  BOOST_TEST((report.end == MinorCycleEnd::threshold));
  BOOST_TEST(std::abs(model.flux_jy() / flux - 1) < 0.02);
  Image left = dirty;
  subtract(Convolution<double>(beam, 2)(model.image(2)), left);
  // Averaged over a beam or two, a bowl stands out of the noise.
  const Image smooth = gaussian_blur(left, 2 * beam_pixels, 2);
  BOOST_TEST(*std::min_element(smooth.pixel.begin(), smooth.pixel.end()) > -3 * noise);
}

BOOST_AUTO_TEST_CASE(a_point_source_becomes_points) {
  Image sky(side, side);
  sky.at(125, 131) = 1;
  const Image beam = psf(), dirty = observed(sky, beam, 1e-4);
  const JointClean minor({&beam}, {.scale_pixels = {0, 6, 15}, .small_scale_bias = 0, .threads = 2});
  const MinorCycleReport report =
      minor.clean(dirty, {.gain = 0.2, .max_iterations = 100, .threshold_jy = 0.01, .stop_requested = {}});
  for (const Component& c : report.components) BOOST_TEST((c.scale == 0 && c.row == 125 && c.column == 131));
}

/// A pixel's flux leaves it with its scale, whose size is what the residual loses.
BOOST_AUTO_TEST_CASE(gain_one_takes_a_component_of_its_own_scale_at_once) {
  Image sky(side, side);
  sky.at(120, 140) = 5;
  sky = gaussian_blur(sky, 15, 2);
  const Image beam = psf(), dirty = observed(sky, beam, 1e-9);
  const JointClean minor({&beam}, {.scale_pixels = {0, 6, 15}, .small_scale_bias = 0, .threads = 2});
  const MinorCycleReport report =
      minor.clean(dirty, {.gain = 1, .max_iterations = 1, .threshold_jy = 0.01, .stop_requested = {}});
  BOOST_REQUIRE(report.iterations() == 1);
  const Component& c = report.components.front();
  BOOST_TEST((c.scale == 2 && c.row == 120 && c.column == 140));
  // Gaussians cut at 1e-9 of their peak, and single precision.
  BOOST_TEST(std::abs(c.flux_jy - 5) < 1e-5);
  BOOST_TEST(report.peak_jy < 1e-5 * largest_magnitude(dirty));
}

BOOST_AUTO_TEST_CASE(the_bias_favours_small_scales) {
  Image sky(side, side);
  sky.at(120, 140) = 5;
  sky = gaussian_blur(sky, 13, 2);
  const Image beam = psf(), dirty = observed(sky, beam, 1e-9);
  const auto first_scale = [&](double bias) {
    const JointClean minor({&beam}, {.scale_pixels = {0, 6, 15}, .small_scale_bias = bias, .threads = 2});
    return minor.clean(dirty, {.gain = 0.1, .max_iterations = 1, .threshold_jy = 0.01, .stop_requested = {}})
        .components.front()
        .scale;
  };
  BOOST_TEST(first_scale(0.99) < first_scale(0));
}

BOOST_AUTO_TEST_CASE(wide_components_keep_off_edges_and_masks) {
  Image mask(side, side), sky(side, side);
  for (int r = 100; r < 160; ++r)
    for (int c = 100; c < 160; ++c) mask.at(r, c) = 1;
  sky.at(128, 128) = 10;
  sky = gaussian_blur(sky, 60, 2);
  const Image beam = psf(), dirty = observed(sky, beam, 1e-3);
  const JointClean minor({&beam}, {.scale_pixels = {0, 15}, .small_scale_bias = 0, .threads = 2});
  const MinorCycleReport report =
      minor.clean(dirty, {.gain = 0.1, .max_iterations = 500, .threshold_jy = 0.01, .mask = &mask, .stop_requested = {}});
  // σ = 15/2.355 pixels: a straight edge 1.28 σ away leaves nine tenths.
  for (const Component& c : report.components) {
    const int from_edge = std::min({c.row - 99, 160 - c.row, c.column - 99, 160 - c.column});
    BOOST_REQUIRE(from_edge >= (c.scale == 0 ? 1 : 8));
  }
}

/// More places of wide scales are brighter than any point than are looked at together.
BOOST_AUTO_TEST_CASE(what_fills_the_image_is_cleaned_to_the_threshold) {
  constexpr int wide = 512;
  Image point(wide, wide), sky(wide, wide);
  point.at(wide / 2, wide / 2) = sky.at(wide / 2, wide / 2) = 1;
  Image beam = gaussian_blur(point, beam_pixels, 2), dirty = gaussian_blur(sky, 300, 2);
  for (Image* image : {&beam, &dirty}) {
    const double peak = image->at(wide / 2, wide / 2);
    for (double& pixel : image->pixel) pixel /= peak;
  }
  const JointClean minor({&beam}, {.scale_pixels = {0, 5, 20}, .threads = 2});
  const MinorCycleReport report = minor.clean(
      dirty, {.gain = 0.2, .max_iterations = 100000, .threshold_jy = 0.1, .to_the_last = false, .stop_requested = {}});
  BOOST_TEST((report.end == MinorCycleEnd::threshold));
  ComponentModel model(wide, wide, minor.scale_pixels());
  model.add(report.components);
  subtract(Convolution<double>(beam, 2)(model.image(2)), dirty);
  BOOST_TEST(largest_magnitude(dirty) < 0.15);
  BOOST_TEST(report.peak_jy > 0.05);
}

/// The PSF of an array without short baselines leaves nothing of a wide Gaussian but its own errors.
BOOST_AUTO_TEST_CASE(a_scale_that_the_array_does_not_see_is_left_out) {
  Image beam = psf();
  subtract(gaussian_blur(beam, 30, 2), beam);
  const double peak = beam.at(side / 2, side / 2);
  for (double& pixel : beam.pixel) pixel /= peak;
  Image sky(side, side);
  sky.at(125, 131) = 1;
  const JointClean minor({&beam}, {.scale_pixels = {0, 6, 120}, .threads = 2});
  const MinorCycleReport report =
      minor.clean(observed(sky, beam, 1e-4), {.gain = 0.2, .max_iterations = 1000, .threshold_jy = 0.01, .stop_requested = {}});
  BOOST_TEST((report.end == MinorCycleEnd::threshold));
  for (const Component& c : report.components) BOOST_TEST(c.scale < 2);
}

/// Without points in the list, nothing can be done about a source at the border; nor is it tried for ever.
BOOST_AUTO_TEST_CASE(what_no_scale_can_reach_ends_it) {
  Image sky(side, side);
  sky.at(2, 100) = 1;
  const Image beam = psf(), dirty = observed(sky, beam, 1e-6);
  const JointClean minor({&beam}, {.scale_pixels = {15}, .small_scale_bias = 0, .threads = 2});
  const MinorCycleReport report =
      minor.clean(dirty, {.gain = 0.1, .max_iterations = 1000000, .threshold_jy = 0.1, .stop_requested = {}});
  BOOST_TEST((report.end == MinorCycleEnd::no_place));
  BOOST_TEST(report.iterations() < 10000);
}

BOOST_AUTO_TEST_CASE(scales_that_make_no_sense_are_refused) {
  const Image beam = psf();
  for (const std::vector<double>& scales :
       std::vector<std::vector<double>>{{}, {-1}, {5, 5}, {5, 0}, {0, std::numeric_limits<double>::infinity()}})
    BOOST_CHECK_THROW(JointClean({&beam}, {.scale_pixels = scales, .small_scale_bias = 0}), std::invalid_argument);
  for (const double bias : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
    BOOST_CHECK_THROW(JointClean({&beam}, {.scale_pixels = {0}, .small_scale_bias = bias}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
