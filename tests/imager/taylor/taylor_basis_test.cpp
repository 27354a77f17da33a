#include "imager/taylor/taylor_basis.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

BOOST_AUTO_TEST_SUITE(taylor_basis)

using namespace misfit::imager;

namespace {

/// Samples of weights w at distances x.
struct Band {
  std::vector<double> x, w;

  double moment(int k) const {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum += w[i] * std::pow(x[i], k);
      weight += w[i];
    }
    return sum / weight;
  }
  std::vector<double> peaks(int terms) const {
    std::vector<double> result;
    for (int k = 0; k < 2 * terms - 1; ++k) result.push_back(moment(k));
    return result;
  }
  /// Σ w x^t V / Σ w of real data.
  TaylorValues residual(const std::vector<double>& data, int terms) const {
    TaylorValues result{};
    double weight = 0;
    for (const double one : w) weight += one;
    for (int t = 0; t < terms; ++t)
      for (std::size_t i = 0; i < x.size(); ++i)
        result[static_cast<std::size_t>(t)] += w[i] * std::pow(x[i], t) * data[i] / weight;
    return result;
  }
};

/// Off its middle, with weights.
Band band() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.2, 1);
  Band made;
  for (int i = 0; i < 40; ++i) {
    made.x.push_back(-0.15 + 0.5 * i / 40);
    made.w.push_back(uniform(random));
  }
  return made;
}

double sum_of_squares(const Band& of, const std::vector<double>& data, const TaylorValues& coefficient) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < of.x.size(); ++i) {
    double fit = 0;
    for (std::size_t t = coefficient.size(); t-- > 0;) fit = fit * of.x[i] + coefficient[t];
    sum += of.w[i] * std::pow(data[i] - fit, 2);
    weight += of.w[i];
  }
  return sum / weight;
}

std::vector<double> normal_numbers(std::size_t count) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> data(count);
  for (double& value : data) value = normal(random);
  return data;
}

}  // namespace

/// A small step in any coefficient makes the fit worse.
BOOST_AUTO_TEST_CASE(the_principal_solution_fits_best) {
  const Band of = band();
  const std::vector<double> data = normal_numbers(of.x.size());
  for (const int terms : {1, 2, 3}) {
    const TaylorBasis basis(of.peaks(terms));
    const TaylorValues best = basis.coefficients(basis.coordinates(of.residual(data, terms)));
    const double least = sum_of_squares(of, data, best);
    for (std::size_t t = 0; t < static_cast<std::size_t>(terms); ++t)
      for (const double step : {-1e-3, 1e-3}) {
        TaylorValues other = best;
        other[t] += step;
        BOOST_TEST(sum_of_squares(of, data, other) > least);
      }
  }
}

BOOST_AUTO_TEST_CASE(the_square_of_the_brightness_is_what_the_fit_takes_off_the_sum_of_squares) {
  const Band of = band();
  const std::vector<double> data = normal_numbers(of.x.size());
  for (const int terms : {1, 2, 3}) {
    const TaylorBasis basis(of.peaks(terms));
    const TaylorValues y = basis.coordinates(of.residual(data, terms));
    const double taken = sum_of_squares(of, data, {}) - sum_of_squares(of, data, basis.coefficients(y));
    // Rounding of doubles by the condition of H, some 1e4 for three terms.
    BOOST_TEST(std::abs(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] - taken) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(of_one_term_the_brightness_is_the_residual_and_the_coefficient_that_over_the_peak) {
  const TaylorBasis basis({0.8});
  BOOST_TEST(std::abs(basis.coordinates({0.3})[0] - 0.3) < 1e-15);
  BOOST_TEST(std::abs(basis.coefficients(basis.coordinates({0.3}))[0] - 0.3 / 0.8) < 1e-15);
}

BOOST_AUTO_TEST_CASE(images_hold_each_pixels_values_and_are_nan_where_a_residual_is) {
  const TaylorBasis basis(band().peaks(2));
  Image first(3, 2), second(3, 2);
  for (std::size_t i = 0; i < 6; ++i) {
    first.pixel[i] = 1 + double(i);
    second.pixel[i] = 0.1 * double(i * i);
  }
  second.pixel[4] = std::nan("");
  const Image bright = brightness(basis, {&first, &second}, 2);
  const std::vector<Image> principal = principal_solution(basis, {&first, &second}, 2);
  for (std::size_t i = 0; i < 6; ++i) {
    const TaylorValues y = basis.coordinates({first.pixel[i], second.pixel[i]});
    if (i == 4) {
      BOOST_TEST(std::isnan(bright.pixel[i]));
      BOOST_TEST(std::isnan(principal[0].pixel[i]));
      continue;
    }
    BOOST_TEST(std::abs(bright.pixel[i] - std::hypot(y[0], y[1])) < 1e-14);
    for (std::size_t t = 0; t < 2; ++t) BOOST_TEST(principal[t].pixel[i] == basis.coefficients(y)[t]);
  }
}

BOOST_AUTO_TEST_CASE(frequencies_too_few_for_the_terms_are_an_error) {
  const Band one{{0.1}, {1}}, two{{-0.1, 0.1}, {1, 1}}, three{{-0.1, 0, 0.1}, {1, 1, 1}};
  BOOST_CHECK_THROW(TaylorBasis(one.peaks(2)), std::runtime_error);
  BOOST_CHECK_NO_THROW(TaylorBasis(two.peaks(2)));
  BOOST_CHECK_THROW(TaylorBasis(two.peaks(3)), std::runtime_error);
  BOOST_CHECK_NO_THROW(TaylorBasis(three.peaks(3)));
}

BOOST_AUTO_TEST_CASE(a_number_of_psfs_that_no_number_of_terms_has_is_an_error) {
  for (const std::size_t count : {0, 2, 4, 7})
    BOOST_CHECK_THROW(TaylorBasis(std::vector<double>(count, 1)), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
