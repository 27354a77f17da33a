#include "imager/clean/minor_cycle.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>

#include "imager/clean/deconvolver.h"
#include "imager/data/noise.h"
#include "tests/imager/clean/convolution.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(minor_cycle)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int width = 150, height = 120;

/// A beam of 4 pixels with random sidelobes that fall off with distance.
Image psf() {
  Image image = random_image(width, height, 99);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const double distance2 = std::pow(r - height / 2, 2) + std::pow(c - width / 2, 2);
      image.at(r, c) = std::exp(-4 * std::log(2.0) * distance2 / 16) + 0.02 * image.at(r, c) / (1 + distance2 / 400);
    }
  image.at(height / 2, width / 2) = 1;
  return image;
}

Image dirty() {
  Image sky(width, height);
  sky.at(60, 75) = 1;
  sky.at(31, 40) = -0.5;
  sky.at(90, 110) = 0.7;
  sky.at(92, 113) = 0.4;
  const Image smooth = Convolution<double>(psf(), 2)(sky);
  Image noise = random_image(width, height, 7);
  for (std::size_t i = 0; i < noise.pixel.size(); ++i) noise.pixel[i] = smooth.pixel[i] + 0.002 * noise.pixel[i];
  return noise;
}

DeconvolverChoice choice(const std::string& name, int threads = 2) {
  return {.name = name, .scale_pixels = {0, 5, 12}, .small_scale_bias = 0.2, .threads = threads};
}

MinorCycleOptions deep() {
  return {.gain = 0.2, .max_iterations = 2000, .threshold_jy = 0.02, .mask = nullptr, .stop_requested = {}};
}

struct Cleaned {
  MinorCycleReport report;
  Image model;
  Image left;  ///< residual − model ⊗ PSF
};

Cleaned cleaned(const std::string& name, const Image& residual, const MinorCycleOptions& options, int threads = 2) {
  const Image beam = psf();
  const auto minor = make_deconvolver(choice(name, threads), {&beam});
  Cleaned result{minor->clean(residual, options), {}, residual};
  ComponentModel model(width, height, minor->scale_pixels());
  model.add(result.report.components);
  result.model = model.image(1);
  subtract(Convolution<double>(beam, 1)(result.model), result.left);
  return result;
}

}  // namespace

BOOST_DATA_TEST_CASE(the_residual_of_its_components_reaches_the_threshold, bdata::make(deconvolver_names()), name) {
  const Cleaned is = cleaned(name, dirty(), deep());
  BOOST_TEST((is.report.end == MinorCycleEnd::threshold));
  // Single precision: some hundred subtractions of values below 1.
  BOOST_TEST(largest_magnitude(is.left) <= deep().threshold_jy + 1e-5);
  BOOST_TEST(std::abs(is.report.peak_jy - largest_magnitude(is.left)) < 1e-5);
  BOOST_TEST(is.report.iterations() > 20);
  double flux = 0;  // a wide negative component next to a positive one would show here
  for (const double pixel : is.model.pixel) flux += pixel;
  BOOST_TEST(std::abs(flux - 1.6) < 0.1);
}

BOOST_DATA_TEST_CASE(it_finds_no_more_components_than_it_may, bdata::make(deconvolver_names()), name) {
  for (const int limit : {0, 1, 17}) {
    MinorCycleOptions options = deep();
    options.max_iterations = limit;
    const Cleaned is = cleaned(name, dirty(), options);
    BOOST_TEST(is.report.iterations() == limit);
    BOOST_TEST((is.report.end == MinorCycleEnd::iterations));
  }
}

BOOST_DATA_TEST_CASE(points_lie_within_the_mask, bdata::make(deconvolver_names()), name) {
  Image mask(width, height);
  for (int r = 50; r < 70; ++r)
    for (int c = 65; c < 85; ++c) mask.at(r, c) = 1;
  MinorCycleOptions options = deep();
  options.mask = &mask;
  const Cleaned is = cleaned(name, dirty(), options);
  BOOST_TEST((is.report.end == MinorCycleEnd::threshold));
  for (const Component& c : is.report.components) BOOST_REQUIRE(mask.at(c.row, c.column) == 1);
  BOOST_TEST(std::abs(is.left.at(60, 75)) <= deep().threshold_jy + 1e-5);
  BOOST_TEST(std::abs(is.left.at(90, 110)) > 0.5);
}

BOOST_DATA_TEST_CASE(pixels_that_are_nan_are_never_cleaned, bdata::make(deconvolver_names()), name) {
  Image residual = dirty();
  for (int r = 85; r < 100; ++r)
    for (int c = 100; c < 120; ++c) residual.at(r, c) = std::numeric_limits<double>::quiet_NaN();
  const Cleaned is = cleaned(name, residual, deep());
  BOOST_TEST(!is.report.components.empty());
  for (const Component& c : is.report.components) BOOST_REQUIRE(!std::isnan(residual.at(c.row, c.column)));
}

BOOST_DATA_TEST_CASE(its_components_do_not_depend_on_the_number_of_threads, bdata::make(deconvolver_names()), name) {
  BOOST_TEST((cleaned(name, dirty(), deep(), 1).model.pixel == cleaned(name, dirty(), deep(), 3).model.pixel));
}

BOOST_DATA_TEST_CASE(nothing_is_found_where_nothing_is, bdata::make(deconvolver_names()), name) {
  Image nan(width, height);
  std::fill(nan.pixel.begin(), nan.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  for (const Image& empty : {Image(width, height), nan}) {
    const Cleaned is = cleaned(name, empty, deep());
    BOOST_TEST(is.report.iterations() == 0);
    BOOST_TEST(is.report.peak_jy == 0);
  }
  const Image mask(width, height);
  MinorCycleOptions options = deep();
  options.mask = &mask;
  BOOST_TEST(cleaned(name, dirty(), options).report.iterations() == 0);
}

BOOST_DATA_TEST_CASE(the_user_can_stop_it_at_once, bdata::make(deconvolver_names()), name) {
  MinorCycleOptions options = deep();
  options.stop_requested = [] { return true; };
  const Cleaned is = cleaned(name, dirty(), options);
  BOOST_TEST(is.report.iterations() == 0);
  BOOST_TEST((is.report.end == MinorCycleEnd::stopped));
}

BOOST_DATA_TEST_CASE(images_of_other_sizes_than_the_psf_are_refused, bdata::make(deconvolver_names()), name) {
  const Image beam = psf(), other(width, height - 1);
  const auto minor = make_deconvolver(choice(name), {&beam});
  BOOST_CHECK_THROW(minor->clean(other, deep()), std::invalid_argument);
  MinorCycleOptions options = deep();
  options.mask = &other;
  BOOST_CHECK_THROW(minor->clean(dirty(), options), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_single_pixel_is_cleaned) {
  Image residual(1, 1), beam(1, 1);
  residual.at(0, 0) = 2;
  beam.at(0, 0) = 1;
  for (const std::string& name : deconvolver_names()) {
    MinorCycleOptions options = deep();
    options.max_iterations = 3;
    options.gain = 0.25;
    const auto minor = make_deconvolver({.name = name}, {&beam});
    // A power of two and its products with 3/4 are exact, but a convolution by FFT rounds.
    BOOST_TEST(std::abs(minor->clean(residual, options).peak_jy - 2 * 0.75 * 0.75 * 0.75) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(a_deconvolver_that_is_not_known_is_refused) {
  const Image beam = psf();
  BOOST_CHECK_THROW(make_deconvolver(choice("maxent"), {&beam}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
