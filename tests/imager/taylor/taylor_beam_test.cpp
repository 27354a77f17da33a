#include "imager/taylor/taylor_beam.h"

#include <Eigen/Dense>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "imager/beams/airy_pattern.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(taylor_beam)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

constexpr double reference_hz = 1.5e9;
const Pattern plain = airy_pattern({25, 0}), blocked = airy_pattern({25, 2.36}), small = airy_pattern({12, 0.75});

/// 32 channels of weights that differ, over `fraction` of the reference frequency about it, of two sorts of dishes by turns
/// where they are mixed.
std::vector<BeamShare> band(double fraction, bool mixed = false) {
  std::vector<BeamShare> shares;
  for (int c = 0; c < 32; ++c)
    shares.push_back({mixed && c % 3 == 0 ? small : blocked, blocked, reference_hz * (1 + fraction * (c - 15.5) / 32),
                      1 + 0.5 * std::sin(c)});
  return shares;
}

/// A row of pixels from the axis, 1/200 of λ/D apart.
const ImageGeometry row{401, 1, speed_of_light_m_s / reference_hz / 25 / 200, {}};
constexpr double limit = 0.1;

TaylorBeam beam_of(const std::vector<BeamShare>& shares, int terms) {
  return {shares, {reference_hz, terms}, row, {{}, limit, 2}};
}

using Spectrum = std::function<double(double x)>;
using Vector = Eigen::VectorXd;

double x_of(const BeamShare& share) {
  return share.frequency_hz / reference_hz - 1;
}

/// The polynomial of so many terms that fits f(share) best, by QR of its design matrix: not by normal equations.
Vector fit(const std::vector<BeamShare>& shares, int terms, const std::function<double(const BeamShare&)>& f) {
  const auto n = static_cast<Eigen::Index>(shares.size());
  Eigen::MatrixXd design(n, terms);
  Vector values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const BeamShare& s = shares[static_cast<std::size_t>(i)];
    const double root = std::sqrt(s.weight);
    for (int t = 0; t < terms; ++t) design(i, t) = root * std::pow(x_of(s), t);
    values(i) = root * f(s);
  }
  return design.householderQr().solve(values);
}

/// Images [term] of a source of this spectrum in each pixel, as the beam lets it be seen.
std::vector<Image> seen(const std::vector<BeamShare>& shares, int terms, const Spectrum& spectrum) {
  std::vector<Image> images(static_cast<std::size_t>(terms), Image(row.width, row.height));
  for (int column = 0; column < row.width; ++column) {
    const double sine = std::abs(row.l(column));
    const Vector c = fit(shares, terms, [&](const BeamShare& s) { return power(s, sine) * spectrum(x_of(s)); });
    for (std::size_t t = 0; t < images.size(); ++t) images[t].at(0, column) = c(static_cast<Eigen::Index>(t));
  }
  return images;
}

std::vector<Image> corrected(const std::vector<BeamShare>& shares, const std::vector<Image>& images) {
  std::vector<const Image*> each;
  for (const Image& image : images) each.push_back(&image);
  return beam_of(shares, static_cast<int>(images.size())).corrected(each);
}

/// Calls check(column, terms there) for all pixels with values. Returns how many there are.
int check_each(const std::vector<Image>& images, const std::function<void(int column, const Vector& terms)>& check) {
  int known = 0;
  for (int column = 0; column < row.width; ++column) {
    if (std::isnan(images.front().at(0, column))) continue;
    ++known;
    Vector terms(static_cast<Eigen::Index>(images.size()));
    for (std::size_t t = 0; t < images.size(); ++t) terms(static_cast<Eigen::Index>(t)) = images[t].at(0, column);
    check(column, terms);
  }
  return known;
}

/// The first coefficients of a / b.
Vector quotient(const Vector& a, const Vector& b) {
  Vector q(a.size());
  for (Eigen::Index t = 0; t < q.size(); ++t) {
    double left = a(t);
    for (Eigen::Index k = 1; k <= t; ++k) left -= b(k) * q(t - k);
    q(t) = left / b(0);
  }
  return q;
}

}  // namespace

/// J solves G J = R exactly where R is that of a product of the beam and such a polynomial. Rounding by the condition of three
/// terms over 5 % of bandwidth, 1e6, and tables that are right to 1e-10.
BOOST_DATA_TEST_CASE(spectra_of_as_many_terms_are_corrected_exactly_whatever_the_beam,
                     bdata::make({2, 3}) * bdata::make({0.05, 0.4, 0.67}) * bdata::make({false, true}), terms, fraction,
                     mixed) {
  const std::vector<BeamShare> shares = band(fraction, mixed);
  for (const Vector& truth :
       {Vector(Eigen::Vector3d(1, 0, 0)), Vector(Eigen::Vector3d(2, -1.4, 0.8)), Vector(Eigen::Vector3d(0.5, 0.5, -3))}) {
    const auto spectrum = [&](double x) { return truth(0) + truth(1) * x + (terms == 3 ? truth(2) * x * x : 0); };
    const int known = check_each(corrected(shares, seen(shares, terms, spectrum)), [&](int, const Vector& sky) {
      for (Eigen::Index t = 0; t < terms; ++t) BOOST_TEST(std::abs(sky(t) - truth(t)) < 1e-6 * std::pow(0.1, 2 - t));
    });
    BOOST_TEST(known > 300);  // of 401; 0.1 lies at 0.96 λ/D
  }
}

BOOST_DATA_TEST_CASE(the_terms_of_the_beam_are_those_of_a_flat_source_of_1_jy,
                     bdata::make({2, 3}) * bdata::make({0.05, 0.67}) * bdata::make({false, true}), terms, fraction, mixed) {
  const std::vector<BeamShare> shares = band(fraction, mixed);
  const std::vector<Image> expected = seen(shares, terms, [](double) { return 1; });
  const int known = check_each(beam_of(shares, terms).terms(), [&](int column, const Vector& beam) {
    for (std::size_t t = 0; t < expected.size(); ++t)
      BOOST_TEST(std::abs(beam(static_cast<Eigen::Index>(t)) - expected[t].at(0, column)) < 1e-6);
    BOOST_TEST(beam(0) > limit - 1e-9);
  });
  BOOST_TEST(known > 300);
}

/// Of two terms at the half-power point α of an Airy disc is −1.48 (Rau & Cornwell 2011 have −1.4 for the VLA's).
BOOST_AUTO_TEST_CASE(an_airy_disc_is_as_steep_as_its_derivative_says) {
  const std::vector<Image> terms = TaylorBeam({{plain, plain, 0.99 * reference_hz, 1}, {plain, plain, 1.01 * reference_hz, 1}},
                                              {reference_hz, 2}, row, {{}, limit, 1})
                                       .terms();
  check_each(terms, [](int column, const Vector& beam) {
    // d ln (2 J₁(x)/x)² / d ln x = −2 x J₂/J₁, to what lies between the two frequencies, 1e-4 / 6 of its third derivative.
    const double x = std::max(1e-9, pi * 25 * std::abs(row.l(column)) * reference_hz / speed_of_light_m_s);
    const double slope = -2 * x * ::jn(2, x) / ::j1(x);
    BOOST_TEST(std::abs(beam(1) / beam(0) - slope) < 2e-3 * (1 + slope * slope));
    if (std::abs(beam(0) - 0.5) < 0.004) BOOST_TEST(std::abs(beam(1) / beam(0) + 1.48) < 0.03);
  });
}

/// Both leave out what is of order (bandwidth/2)^terms: they differ by that times how steep beam and sky are.
BOOST_DATA_TEST_CASE(in_narrow_bands_correction_is_the_division_of_polynomials, bdata::make({2, 3}), terms) {
  const auto power_law = [](double x) { return std::pow(1 + x, -0.7); };
  std::vector<double> largest;
  for (const double fraction : {0.2, 0.1, 0.05}) {
    const std::vector<BeamShare> shares = band(fraction);
    const std::vector<Image> apparent = seen(shares, terms, power_law), beam = beam_of(shares, terms).terms();
    largest.push_back(0);
    check_each(corrected(shares, apparent), [&](int column, const Vector& sky) {
      Vector c(terms), b(terms);
      for (int t = 0; t < terms; ++t) {
        c(t) = apparent[static_cast<std::size_t>(t)].at(0, column);
        b(t) = beam[static_cast<std::size_t>(t)].at(0, column);
      }
      largest.back() = std::max(largest.back(), std::abs(quotient(c, b)(0) - sky(0)));
    });
  }
  BOOST_TEST(largest.front() > 1e-5);  // they are not the same
  // The square where two terms are kept; of three, whose odd power a symmetric band has nothing of, the fourth.
  for (std::size_t i = 1; i < largest.size(); ++i) BOOST_TEST(largest[i] < 0.3 * largest[i - 1]);
}

/// What a power law is to so many terms without a beam, within what the beam changes of the samples' weights.
BOOST_DATA_TEST_CASE(a_power_law_is_what_it_is_without_a_beam,
                     bdata::make({2, 3}) * bdata::make({-0.7, 1.0, 0.0}) * bdata::make({0.1, 0.2, 0.4}), terms, alpha,
                     fraction) {
  const std::vector<BeamShare> shares = band(fraction);
  const auto power_law = [alpha = alpha](double x) { return 2.5 * std::pow(1 + x, alpha); };
  const Vector without = fit(shares, terms, [&](const BeamShare& s) { return power_law(x_of(s)); });
  check_each(corrected(shares, seen(shares, terms, power_law)), [&](int, const Vector& sky) {
    // Weights change by at most |b_1/b_0| ≤ 5 times the half band, and the curve that is left is α (α − 1)/2 x².
    const double left = std::abs(alpha * (alpha - 1)) / 2 * fraction * fraction / 4;
    BOOST_TEST(std::abs(sky(0) - without(0)) < 2.5 * left + 1e-9);
    BOOST_TEST(std::abs(sky(1) / sky(0) - without(1) / without(0)) < 5 * left + 1e-6);
    BOOST_TEST(std::abs(sky(1) / sky(0) - alpha) < 6 * left + 1e-6);
  });
}

BOOST_AUTO_TEST_CASE(pixels_beyond_the_limit_have_no_value_in_any_term) {
  const std::vector<BeamShare> shares = band(0.4);
  const std::vector<Image> beam = beam_of(shares, 2).terms();
  const std::vector<Image> flat = seen(shares, 2, [](double) { return 1; }), sky = corrected(shares, flat);
  bool reached = false;
  for (int column = row.centre_column(); column < row.width; ++column) {
    reached = reached || flat[0].at(0, column) < limit - 1e-6;
    for (const Image* image : {&beam[0], &beam[1], &sky[0], &sky[1]}) BOOST_TEST(std::isnan(image->at(0, column)) == reached);
  }
  BOOST_TEST(reached);
}

BOOST_AUTO_TEST_SUITE_END()
