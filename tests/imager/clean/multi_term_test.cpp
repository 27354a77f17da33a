#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/clean/gaussian_blur.h"
#include "imager/clean/joint_clean.h"
#include "imager/data/noise.h"
#include "tests/imager/clean/convolution.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(multi_term)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int side = 96;

/// Spectral PSFs of a Gaussian uv coverage that grows with frequency, in a bowl: at x is the beam of width 5/(1+x) pixels.
struct Beams {
  std::vector<Image> psf;  ///< [k]
  std::vector<const Image*> pointers() const {
    std::vector<const Image*> result;
    for (const Image& image : psf) result.push_back(&image);
    return result;
  }
};

Image beam_at(double x) {
  Image point(side, side);
  point.at(side / 2, side / 2) = 1;
  Image beam = gaussian_blur(point, 5 / (1 + x), 2);
  subtract(gaussian_blur(point, 60 / (1 + x), 2), beam);
  const double peak = beam.at(side / 2, side / 2);
  for (double& pixel : beam.pixel) pixel /= peak;
  return beam;
}

constexpr double distances[] = {-0.3, -0.1, 0.1, 0.3};

void add(double factor, const Image& image, Image& to) {
  for (std::size_t i = 0; i < to.pixel.size(); ++i) to.pixel[i] += factor * image.pixel[i];
}

Beams beams(int terms) {
  Beams made;
  made.psf.assign(static_cast<std::size_t>(2 * terms - 1), Image(side, side));
  for (const double x : distances)
    for (std::size_t k = 0; k < made.psf.size(); ++k) add(std::pow(x, double(k)) / 4, beam_at(x), made.psf[k]);
  return made;
}

struct Sky {
  int row, column, scale;
  std::vector<double> coefficient;
};

Image at_scale(const Image& image, double scale_pixels) {
  return scale_pixels == 0 ? image : gaussian_blur(image, scale_pixels, 2);
}

/// R_q = Σ_t P_{q+t} ⋆ I_t, by convolutions in double precision.
std::vector<Image> residuals(const Beams& of, const std::vector<Sky>& sky, const std::vector<double>& scale_pixels, int terms) {
  std::vector<Image> result(static_cast<std::size_t>(terms), Image(side, side));
  for (std::size_t t = 0; t < result.size(); ++t) {
    Image image(side, side);
    for (const Sky& s : sky) {
      Image one(side, side);
      one.at(s.row, s.column) = s.coefficient[t];
      add(1, at_scale(one, scale_pixels[static_cast<std::size_t>(s.scale)]), image);
    }
    for (std::size_t q = 0; q < result.size(); ++q) add(1, Convolution<double>(of.psf[q + t], 2)(image), result[q]);
  }
  return result;
}

std::vector<const Image*> pointers(const std::vector<Image>& images) {
  std::vector<const Image*> result;
  for (const Image& image : images) result.push_back(&image);
  return result;
}

const std::vector<Sky> points{{40, 30, 0, {1, -0.7, 0.6}}, {60, 66, 0, {0.5, 0, 0}}, {20, 70, 0, {-0.3, 0.9, -0.5}}};

}  // namespace

BOOST_AUTO_TEST_CASE(points_without_noise_give_their_taylor_coefficients) {
  for (const int terms : {2, 3}) {
    const Beams of = beams(terms);
    const JointClean minor(of.pointers(), {.threads = 2});
    const std::vector<Image> residual = residuals(of, points, {0}, terms);
    const MinorCycleReport report =
        minor.clean(pointers(residual), {.gain = 0.2, .max_iterations = 20000, .threshold_jy = 1e-4, .stop_requested = {}});
    BOOST_TEST((report.end == MinorCycleEnd::threshold));
    ComponentModel model(side, side, {0});
    model.add(report.components);
    const TaylorBasis basis = basis_of(of.pointers());
    for (const Sky& s : points) {
      TaylorValues sum{};
      for (const Component& c : model.components())
        if (std::abs(c.row - s.row) <= 2 && std::abs(c.column - s.column) <= 2)
          for (int t = 0; t < terms; ++t) sum[static_cast<std::size_t>(t)] += c.coefficient_jy(t);
      // What is left has |y| below the threshold: of a coefficient at most √(H⁻¹)_tt times it; neighbours share it.
      for (std::size_t t = 0; t < static_cast<std::size_t>(terms); ++t) {
        TaylorValues unit{};
        double row_norm = 0;
        for (std::size_t a = 0; a < static_cast<std::size_t>(terms); ++a) {
          unit = {};
          unit[a] = 1;
          row_norm = std::hypot(row_norm, basis.coefficients(unit)[t]);
        }
        BOOST_TEST(std::abs(sum[t] - s.coefficient[t]) < 20 * 1e-4 * row_norm);
      }
    }
  }
}

/// Convolved with the PSFs its components are what the residuals have lost.
BOOST_AUTO_TEST_CASE(the_brightest_pixel_left_is_that_of_the_residuals_less_the_components) {
  constexpr int terms = 2;
  const Beams of = beams(terms);
  const JointClean minor(of.pointers(), {.threads = 2});
  std::vector<Image> left = residuals(of, points, {0}, terms);
  const double before = largest_magnitude(brightness(basis_of(of.pointers()), pointers(left), 1));
  const MinorCycleReport report =
      minor.clean(pointers(left), {.gain = 0.1, .max_iterations = 60, .threshold_jy = 0, .stop_requested = {}});
  BOOST_TEST(report.iterations() == 60);
  ComponentModel model(side, side, {0});
  model.add(report.components);
  for (std::size_t t = 0; t < terms; ++t)
    for (std::size_t q = 0; q < terms; ++q)
      subtract(Convolution<double>(of.psf[q + t], 2)(model.image(1, static_cast<int>(t))), left[q]);
  const double after = largest_magnitude(brightness(basis_of(of.pointers()), pointers(left), 1));
  BOOST_TEST(std::abs(report.peak_jy - after) < 1e-5 * before);  // single precision
  BOOST_TEST(after < before);
}

/// At gain 1 the first component is the principal solution of the pixel that takes most off χ².
BOOST_AUTO_TEST_CASE(the_first_component_is_the_principal_solution_of_the_brightest_pixel) {
  constexpr int terms = 3;
  const Beams of = beams(terms);
  const JointClean minor(of.pointers(), {.threads = 2});
  const std::vector<Image> residual = residuals(of, points, {0}, terms);
  const TaylorBasis basis = basis_of(of.pointers());
  const Peak peak = find_peak(brightness(basis, pointers(residual), 1));
  const MinorCycleReport report =
      minor.clean(pointers(residual), {.gain = 1, .max_iterations = 1, .threshold_jy = 0, .stop_requested = {}});
  BOOST_REQUIRE(report.iterations() == 1);
  const Component& c = report.components.front();
  BOOST_TEST((c.row == peak.row && c.column == peak.column));
  const std::vector<Image> principal = principal_solution(basis, pointers(residual), 1);
  for (std::size_t t = 0; t < terms; ++t)  // single precision, by the condition of H
    BOOST_TEST(std::abs(c.coefficient_jy(int(t)) - principal[t].at(c.row, c.column)) < 1e-5);
}

/// Two Gaussians of one scale and different spectra.
BOOST_AUTO_TEST_CASE(a_gaussian_is_found_at_its_scale_with_its_coefficients) {
  constexpr int terms = 2;
  const Beams of = beams(terms);
  const std::vector<double> scales{0, 6, 12};
  const JointClean minor(of.pointers(), {.scale_pixels = scales, .threads = 2});
  const std::vector<Sky> sky{{44, 50, 2, {5, -3.5}}};
  const std::vector<Image> residual = residuals(of, sky, scales, terms);
  const MinorCycleReport report =
      minor.clean(pointers(residual), {.gain = 1, .max_iterations = 1, .threshold_jy = 0.01, .stop_requested = {}});
  BOOST_REQUIRE(report.iterations() == 1);
  const Component& c = report.components.front();
  BOOST_TEST((c.scale == 2 && c.row == 44 && c.column == 50));
  // Gaussians cut at 1e-9 of their peak, and single precision by the condition of H.
  for (std::size_t t = 0; t < terms; ++t) BOOST_TEST(std::abs(c.coefficient_jy(int(t)) - sky[0].coefficient[t]) < 1e-3);
}

BOOST_AUTO_TEST_CASE(components_do_not_depend_on_the_number_of_threads_and_lie_within_the_mask) {
  constexpr int terms = 2;
  const Beams of = beams(terms);
  const std::vector<Image> residual = residuals(of, points, {0}, terms);
  Image mask(side, side);
  for (int r = 55; r < 65; ++r)
    for (int c = 60; c < 72; ++c) mask.at(r, c) = 1;
  const MinorCycleOptions options{
      .gain = 0.1, .max_iterations = 300, .threshold_jy = 0.01, .mask = &mask, .stop_requested = {}};
  const MinorCycleReport one = JointClean(of.pointers(), {.threads = 1}).clean(pointers(residual), options);
  const MinorCycleReport two = JointClean(of.pointers(), {.threads = 2}).clean(pointers(residual), options);
  BOOST_REQUIRE(one.iterations() == two.iterations());
  BOOST_TEST(one.iterations() > 0);
  for (std::size_t i = 0; i < one.components.size(); ++i) {
    const Component &a = one.components[i], &b = two.components[i];
    BOOST_TEST((a.row == b.row && a.column == b.column && a.flux_jy == b.flux_jy && a.further_jy == b.further_jy));
    BOOST_TEST(mask.at(a.row, a.column) == 1);
  }
}

BOOST_AUTO_TEST_CASE(residuals_of_other_numbers_or_sizes_are_refused) {
  const Beams of = beams(2);
  const JointClean minor(of.pointers(), {.threads = 1});
  const Image right(side, side), wrong(side, side + 1);
  BOOST_CHECK_THROW(minor.clean({&right}, {}), std::invalid_argument);
  BOOST_CHECK_THROW(minor.clean({&right, &wrong}, {}), std::invalid_argument);
  BOOST_CHECK_THROW(minor.clean({&right, &right}, {.mask = &wrong, .stop_requested = {}}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
