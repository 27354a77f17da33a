#include "imager/clean/scaled_residual.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>

#include "imager/clean/bright_places.h"
#include "imager/clean/gaussian_blur.h"
#include "imager/data/noise.h"
#include "tests/imager/clean/convolution.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(scaled_residual)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A beam of 4 pixels, weaker for further terms, and sidelobes that reach everywhere.
std::vector<Image> psfs(int width, int height, int terms) {
  std::vector<Image> result;
  for (int k = 0; k < 2 * terms - 1; ++k) {
    Image& image = result.emplace_back(random_image(width, height, 50U + static_cast<unsigned>(k)));
    for (double& pixel : image.pixel) pixel *= 0.01;
    const double peak = k % 2 == 0 ? std::pow(0.3, k) / (k + 1) : 0.01 * std::pow(0.3, k);  // mean powers over ±0.3
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const double distance2 = std::pow(r - height / 2, 2) + std::pow(c - width / 2, 2);
        image.at(r, c) = peak * (image.at(r, c) + std::exp(-4 * std::log(2.0) * distance2 / 16));
      }
    image.at(height / 2, width / 2) = peak;
  }
  return result;
}

std::vector<const Image*> pointers(const std::vector<Image>& images) {
  std::vector<const Image*> result;
  for (const Image& image : images) result.push_back(&image);
  return result;
}

Image at_scale(const Image& image, double pixels) {
  return pixels == 0 ? image : gaussian_blur(image, pixels, 2);
}

struct Scene {
  int width, height, terms;
  MultiscaleOptions options;
  std::vector<Image> psf = psfs(width, height, terms);
  std::vector<Image> residual{};
  ScaledPsf scaled{pointers(psf), options};
  ScaledFft fft{pointers(psf), scales_looked_at(options), 2};

  Scene(int w, int h, int t, const std::vector<double>& scales)
      : width(w), height(h), terms(t), options{.scale_pixels = scales, .small_scale_bias = 0.2, .threads = 2} {
    for (int term = 0; term < t; ++term) residual.push_back(random_image(w, h, static_cast<unsigned>(term)));
  }
  ScaledResidual left(const Image* mask = nullptr) const { return {pointers(residual), mask, scaled, fft, 2}; }

  /// What components leave of the residuals, by convolutions in double precision.
  std::vector<Image> should_leave(const ComponentModel& model) const {
    std::vector<Image> result = residual;
    for (std::size_t t = 0; t < residual.size(); ++t)
      for (std::size_t q = 0; q < residual.size(); ++q)
        subtract(Convolution<double>(psf[q + t], 2)(model.image(2, static_cast<int>(t))), result[q]);
    return result;
  }
};

std::vector<Component> components(const Scene& scene, int count) {
  std::vector<Component> result;
  const int scales = static_cast<int>(scene.options.scale_pixels.size());
  for (int i = 0; i < count; ++i)
    result.push_back({i % scales, (i * 7919) % scene.height, (i * 104729) % scene.width, 1 - 0.02 * i, {0.3, -0.2}});
  return result;
}

/// In the plane's own pixels, where it is not NaN.
double largest_difference(const ScaledResidual& left, std::size_t scale, std::size_t term, const Image& should) {
  const ScaledResidual::Plane& plane = left.plane(scale);
  double largest = 0;
  for (int r = 0; r < plane.height; ++r)
    for (int c = 0; c < plane.width; ++c)
      if (const double value = left.unit_jy() * double{plane.row(term, r)[c]}; !std::isnan(value))
        largest = std::max(largest, std::abs(value - should.at(r * plane.step, c * plane.step)));
  return largest;
}

}  // namespace

BOOST_DATA_TEST_CASE(each_scale_is_the_residual_convolved_with_its_gaussian,
                     bdata::make({150, 161, 96}) ^ bdata::make({120, 97, 200}), width, height) {
  const Scene scene(width, height, 2, {0, 2.5, 11, 23});
  ScaledResidual left = scene.left();
  ComponentModel model(width, height, scene.options.scale_pixels);
  model.add(components(scene, 9));
  for (const bool subtracted : {false, true}) {
    if (subtracted) left.subtract(model);
    const std::vector<Image> should = subtracted ? scene.should_leave(model) : scene.residual;
    for (std::size_t s = 0; s < scene.scaled.scales().size(); ++s)
      for (std::size_t q = 0; q < 2; ++q)  // single precision of values near 3
        BOOST_TEST(largest_difference(left, s, q, at_scale(should[q], scene.scaled.scales()[s].looked_at.pixels)) < 1e-5);
  }
  BOOST_TEST(left.plane(2).step == 2);
  BOOST_TEST(left.plane(3).step == 4);
}

/// The definition of where Gaussians may lie, by their sums.
BOOST_AUTO_TEST_CASE(components_may_lie_where_nine_tenths_of_them_are_allowed) {
  Scene scene(150, 120, 1, {0, 8});
  for (int r = 40; r < 44; ++r) scene.residual[0].at(r, 70) = nan;
  Image mask(150, 120);
  for (int r = 20; r < 100; ++r)
    for (int c = 20; c < 130; ++c) mask.at(r, c) = c == 50 ? 0 : 1;
  Image allowed = mask;
  for (int r = 40; r < 44; ++r) allowed.at(r, 70) = 0;
  const Image part = at_scale(allowed, 8);
  const ScaledResidual left = scene.left(&mask);
  for (int r = 0; r < 120; ++r)
    for (int c = 0; c < 150; ++c) {
      BOOST_REQUIRE(std::isnan(left.plane(0).row(0, r)[c]) == (allowed.at(r, c) == 0));
      const bool may = allowed.at(r, c) != 0 && part.at(r, c) >= 0.9 && r >= 16 && r < 104 && c >= 16 && c < 134;
      if (std::abs(part.at(r, c) - 0.9) > 1e-5) BOOST_REQUIRE(std::isnan(left.plane(1).row(0, r)[c]) != may);
    }
}

/// Components that are taken off near tiles at once and off far ones later leave what all of them do.
BOOST_DATA_TEST_CASE(bright_places_lose_what_the_residual_loses, bdata::make({1, 2, 3}), terms) {
  const Scene scene(700, 660, terms, {0});
  const ScaledResidual left = scene.left();
  BrightPlaces bright(left, scene.scaled, 0.25, 2);
  ComponentModel model(700, 660, {0});
  for (int i = 0; i < 40; ++i) {
    const BrightPlaces::Place at = bright.brightest();
    const TaylorValues coefficient{0.9 * at.residual[0], terms > 1 ? -0.3 : 0, terms > 2 ? 0.2 : 0};
    bright.subtract(at, coefficient);
    model.add({{0,
                at.row,
                at.column,
                coefficient[0] * left.unit_jy(),
                {coefficient[1] * left.unit_jy(), coefficient[2] * left.unit_jy()}}});
  }
  BOOST_TEST(bright.outstanding() > 0);
  BOOST_REQUIRE(bright.subtract_outstanding());
  BOOST_TEST(bright.outstanding() == 0);
  const std::vector<Image> should = scene.should_leave(model);
  const BrightPlaces::Place at = bright.brightest();
  for (std::size_t t = 0; t < should.size(); ++t)
    BOOST_TEST(std::abs(left.unit_jy() * at.residual[t] - should[t].at(at.row, at.column)) < 1e-4);
  const TaylorBasis& basis = scene.scaled.scales().front().basis;
  BOOST_TEST(std::abs(left.unit_jy() * bright.point_brightness() - largest_magnitude(brightness(basis, pointers(should), 2))) <
             1e-3);
}

/// A component of one scale is taken off places of all.
BOOST_AUTO_TEST_CASE(bright_places_of_all_scales_lose_a_component) {
  const Scene scene(300, 280, 2, {0, 6, 15});
  ScaledResidual left = scene.left();
  BrightPlaces bright(left, scene.scaled, 0, 2);
  for (int i = 0; i < 30; ++i) {
    const BrightPlaces::Place at = bright.brightest();
    const LookedAt& scale = scene.scaled.scales()[at.scale].looked_at;
    const TaylorValues coefficient =
        scene.scaled.scales()[at.scale].basis.coefficients(scene.scaled.scales()[at.scale].basis.coordinates(at.residual));
    bright.subtract(at, coefficient);
    ComponentModel model(300, 280, scene.options.scale_pixels);
    model.add({{scale.index, at.row, at.column, coefficient[0] * left.unit_jy(), {coefficient[1] * left.unit_jy()}}});
    left.subtract(model);
    const double should = BrightPlaces(left, scene.scaled, 0, 2).brightness();
    BOOST_TEST(std::abs(bright.brightness() / should - 1) < 1e-3);
  }
}

BOOST_AUTO_TEST_SUITE_END()
