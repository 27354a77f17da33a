#include "imager/taylor/spectral_index.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "imager/data/noise.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(spectral_index)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int side = 256;

/// Two images of noise σ_0, σ_1 with a correlation.
std::vector<Image> noise(double sigma_0, double sigma_1, double correlation) {
  std::vector<Image> made{random_image(side, side, 1), random_image(side, side, 2)};
  for (std::size_t i = 0; i < made[0].pixel.size(); ++i) {
    const double a = made[0].pixel[i], b = made[1].pixel[i];
    made[0].pixel[i] = sigma_0 * a;
    made[1].pixel[i] = sigma_1 * (correlation * a + std::sqrt(1 - correlation * correlation) * b);
  }
  return made;
}

Image constant(double value) {
  Image image(side, side);
  for (double& pixel : image.pixel) pixel = value;
  return image;
}

}  // namespace

/// Taylor coefficients of (ν/ν_0)^(α + β ln(ν/ν_0)), by numerical differentiation.
BOOST_AUTO_TEST_CASE(index_and_curvature_are_those_whose_taylor_coefficients_are_given) {
  constexpr double alpha = -0.7, beta = 0.15, flux = 3, h = 1e-4;
  const auto spectrum = [=](double x) { return flux * std::pow(1 + x, alpha + beta * std::log(1 + x)); };
  const double first = (spectrum(h) - spectrum(-h)) / (2 * h);
  const double second = (spectrum(h) - 2 * spectrum(0) + spectrum(-h)) / (h * h) / 2;
  const std::vector<Image> residual(3, random_image(side, side, 1));
  std::vector<Image> small = residual;
  for (Image& image : small)
    for (double& pixel : image.pixel) pixel *= 1e-3;
  const SpectralImages made = spectral_images({constant(flux), constant(first), constant(second)}, small, 2);
  // Differences err by h² times the third and fourth derivatives, of some ten times the flux.
  BOOST_TEST(std::abs(made.alpha.at(5, 7) - alpha) < 1e-6);
  BOOST_TEST(std::abs(made.beta.at(5, 7) - beta) < 1e-6);
}

/// Where pixels see the terms apart by different amounts, as in a mosaic, each has the noise of its own H⁻¹.
BOOST_AUTO_TEST_CASE(the_error_of_the_index_follows_what_each_pixel_sees) {
  constexpr double flux = 1, alpha = -0.8, sigma = 0.002;
  std::vector<Image> peaks(2, Image(side, side)), y = noise(sigma, sigma, 0), dirty(2, Image(side, side));
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double mean = 0.1 * column / side - 0.05, square = mean * mean + 0.002 + 0.01 * row / side;
      peaks[0].at(row, column) = mean;
      peaks[1].at(row, column) = square;
      // R = L y has the covariance H of noise, for H = L Lᵀ = (1, mean; mean, square)
      dirty[0].at(row, column) = y[0].at(row, column);
      dirty[1].at(row, column) = mean * y[0].at(row, column) + std::sqrt(square - mean * mean) * y[1].at(row, column);
    }
  const std::vector<Image> residual = principal_solution(peaks, {&dirty[0], &dirty[1]}, 2);
  std::vector<Image> restored = residual;
  for (std::size_t i = 0; i < restored[0].pixel.size(); ++i) {
    restored[0].pixel[i] += flux;
    restored[1].pixel[i] += alpha * flux;
  }
  const SpectralImages made = spectral_images(restored, residual, 2, solution_noise(peaks, nullptr, 2));
  for (const int first : {0, side / 2}) {  // of rows that tell the terms apart badly, and better
    double square = 0;
    for (int row = first; row < first + side / 4; ++row)
      for (int column = 0; column < side; ++column)
        square += std::pow((made.alpha.at(row, column) - alpha) / made.alpha_error.at(row, column), 2);
    BOOST_TEST(std::sqrt(square / (side / 4 * side)) == 1, boost::test_tools::tolerance(0.03));
  }
}

/// The error of α is the scatter that such noise gives it, over 65536 pixels: 1 % for robust noise of that many, and 1 % for
/// what is of second order in noise over flux, here 1/50.
BOOST_AUTO_TEST_CASE(the_error_of_the_index_is_its_scatter) {
  constexpr double flux = 1, alpha = -1.5;
  for (const double correlation : {0.0, 0.6, -0.6}) {
    const std::vector<Image> residual = noise(0.02, 0.05, correlation);
    std::vector<Image> restored = residual;
    for (std::size_t i = 0; i < restored[0].pixel.size(); ++i) {
      restored[0].pixel[i] += flux;
      restored[1].pixel[i] += alpha * flux;
    }
    const SpectralImages made = spectral_images(restored, residual, 2);
    double square = 0, error = 0;
    for (std::size_t i = 0; i < made.alpha.pixel.size(); ++i) {
      square += std::pow(made.alpha.pixel[i] - alpha, 2);
      error += made.alpha_error.pixel[i];
    }
    const double count = double(made.alpha.pixel.size());
    BOOST_TEST(std::abs(error / count / std::sqrt(square / count) - 1) < 0.02);
  }
}

/// A sky of α and β seen through a beam, of which nothing is left: values are known where those of what was seen are.
BOOST_AUTO_TEST_CASE(indices_of_the_sky_are_known_where_those_of_its_image_are) {
  SpectralImages apparent{constant(-2), constant(0.1), constant(0), 0.3};
  apparent.alpha.at(3, 4) = std::nan("");
  std::vector<Image> sky{constant(2), constant(2 * -0.7), constant(2 * (0.7 * 1.7 / 2 + 0.2))};
  sky[0].at(5, 6) = std::nan("");
  sky[0].at(7, 8) = -1;
  const SpectralImages made = spectral_images_of_sky(sky, apparent, 2);
  BOOST_TEST(std::abs(made.alpha.at(0, 0) + 0.7) < 1e-15);
  BOOST_TEST(std::abs(made.beta.at(0, 0) - 0.2) < 1e-15);
  for (const Image* image : {&made.alpha, &made.beta}) {
    BOOST_TEST(std::isnan(image->at(3, 4)));
    BOOST_TEST(std::isnan(image->at(5, 6)));
    BOOST_TEST(std::isnan(image->at(7, 8)));
  }
  BOOST_TEST(made.level_jy == 0.3);
  sky.pop_back();
  BOOST_TEST(spectral_images_of_sky(sky, apparent, 1).beta.pixel.empty());
}

BOOST_AUTO_TEST_CASE(pixels_below_five_times_the_noise_are_nan) {
  const std::vector<Image> residual = noise(0.1, 0.3, 0);
  const double sigma = robust_noise(residual[0]);
  std::vector<Image> restored{constant(5.01 * sigma), constant(0.1)};
  restored[0].at(3, 4) = 4.99 * sigma;
  restored[0].at(3, 5) = -9 * sigma;
  restored[0].at(3, 6) = std::nan("");
  const SpectralImages made = spectral_images(restored, residual, 1);
  BOOST_TEST(std::abs(made.level_jy - 5 * sigma) < 1e-12);
  for (const Image* image : {&made.alpha, &made.alpha_error}) {
    BOOST_TEST(std::isfinite(image->at(3, 3)));
    for (const int column : {4, 5, 6}) BOOST_TEST(std::isnan(image->at(3, column)));
  }
  BOOST_TEST(made.beta.pixel.empty());
}

BOOST_AUTO_TEST_CASE(without_noise_the_error_is_zero_and_pixels_without_flux_are_nan) {
  std::vector<Image> restored{constant(2), constant(-1)};
  restored[0].at(0, 0) = restored[1].at(0, 0) = 0;
  const SpectralImages made = spectral_images(restored, {constant(0), constant(0)}, 1);
  BOOST_TEST(made.alpha.at(1, 1) == -0.5);
  BOOST_TEST(made.alpha_error.at(1, 1) == 0);
  BOOST_TEST(std::isnan(made.alpha.at(0, 0)));
}

BOOST_AUTO_TEST_SUITE_END()
