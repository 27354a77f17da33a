#include "imager/direct/source_sums.h"

#include <array>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "imager/direct/direct_transform.h"
#include "imager/numerics/constants.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(source_sums)

namespace bdata = boost::unit_test::data;

using namespace misfit::imager;
using namespace misfit::imager::testing;
using Complex = std::complex<double>;

namespace {

/// S exp(+2πi(ul+vm+w(n−1))) exp(−(π fwhm)² (u²+v²) / (4 ln 2)), summed over sources as it stands here.
Complex plain_sum(const std::vector<Source>& sources, const double* uvw_m, double frequency_hz) {
  using Long = long double;
  const Long per_m = static_cast<Long>(frequency_hz) / static_cast<Long>(speed_of_light_m_s);
  const Long u = uvw_m[0] * per_m, v = uvw_m[1] * per_m, w = uvw_m[2] * per_m;
  const Long whole_turn = 2 * std::acos(Long(-1));
  std::complex<Long> sum = 0;
  for (const Source& source : sources) {
    const Long l = source.position.l, m = source.position.m, n = std::sqrt(1 - l * l - m * m);
    const Long half_turns = whole_turn / 2 * source.fwhm_rad;
    const Long gaussian = std::exp(-half_turns * half_turns * (u * u + v * v) / (4 * std::log(Long(2))));
    const std::complex<Long> phasor = std::exp(std::complex<Long>(0, whole_turn * (u * l + v * m + w * (n - 1))));
    sum += static_cast<Long>(source.flux_jy) * gaussian * phasor;
  }
  return Complex(sum);
}

/// Baselines of up to 10⁵ wavelengths at 1.4 GHz, from almost 0, w included.
SampleCoordinates rows_at(std::size_t rows, const std::vector<double>& frequency_hz) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  SampleCoordinates at;
  at.frequency_hz = frequency_hz;
  for (std::size_t row = 0; row < rows; ++row) {
    const double length_m = 2.1e4 * std::pow(10, -2 * std::abs(uniform(random)));
    for (int axis = 0; axis < 3; ++axis) at.uvw_m.edit().push_back(length_m * uniform(random));
  }
  return at;
}

/// Points and Gaussians by turns, over a degree, from unresolved to wide.
std::vector<Source> some_sources(int count, double widest_rad = 1e-3) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Source> sources;
  for (int i = 0; i < count; ++i) {
    const double fwhm_rad = i % 2 == 0 ? 0 : widest_rad * std::pow(10, -4 * std::abs(uniform(random)));
    sources.push_back({{0.01 * uniform(random), 0.01 * uniform(random)}, uniform(random), fwhm_rad});
  }
  return sources;
}

std::vector<double> even_channels(int count, double first_hz, double step_hz) {
  std::vector<double> frequency_hz;
  for (int c = 0; c < count; ++c) frequency_hz.push_back(first_hz + c * step_hz);
  return frequency_hz;
}

/// Largest difference from the plain sum, as a part of the fluxes' sum.
double error_of(const std::vector<Source>& sources, const SampleCoordinates& at) {
  const std::vector<Complex> is = predict_sources(sources, at, 2);
  double largest = 0, flux_jy = 0;
  for (const Source& source : sources) flux_jy += std::abs(source.flux_jy);
  for (std::size_t i = 0; i < is.size(); ++i) {
    const Complex should = plain_sum(sources, &at.uvw_m[3 * (i / at.channels())], at.frequency_hz[i % at.channels()]);
    largest = std::max(largest, std::abs(is[i] - should));
  }
  return largest / flux_jy;
}

/// Recurrences over 64 channels lose up to 64²/2 units of rounding, 4.5e-13; phases here reach 2·10³ turns at 3 GHz, whose
/// rounding, in half a dozen operations, is 2π · 2·10³ · 6 · 1.1e-16 = 8e-12.
constexpr double bound = 1e-11;

}  // namespace

BOOST_DATA_TEST_CASE(they_are_the_defining_sum_for_any_number_of_rows_channels_and_sources,
                     bdata::make({1, 7, 8, 70}) * bdata::make({1, 2, 3, 64, 131}) * bdata::make({1, 2, 5, 40}), rows, channels,
                     sources) {
  const SampleCoordinates at = rows_at(static_cast<std::size_t>(rows), even_channels(channels, 1.4e9, 2e6));
  BOOST_TEST(error_of(some_sources(sources), at) < bound);
}

BOOST_AUTO_TEST_CASE(more_sources_than_are_taken_at_once_add_up) {
  BOOST_TEST(error_of(some_sources(1500), rows_at(9, even_channels(3, 1.4e9, 2e6))) < bound);
}

BOOST_AUTO_TEST_CASE(channels_may_be_uneven_descending_shuffled_or_equal) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(1e9, 3e9);
  std::vector<std::vector<double>> sets{even_channels(70, 1.5e9, -3.7e6), even_channels(5, 1.4e9, 0),
                                        even_channels(100, 1e9, 1e6 / 3), even_channels(64, 1e8, 4e7)};
  sets.emplace_back();
  for (int c = 0; c < 50; ++c) sets.back().push_back(uniform(random));
  sets.push_back(even_channels(64, 1.4e9, 2e6));
  sets.back()[20] += 10;  // a part in 10⁸, which moves phases by more than the bound
  sets.push_back(sets.back());
  std::shuffle(sets.back().begin(), sets.back().end(), random);
  for (const std::vector<double>& frequency_hz : sets)
    BOOST_TEST(error_of(some_sources(30), rows_at(20, frequency_hz)) < bound);
}

BOOST_AUTO_TEST_CASE(fluxes_follow_their_power_laws_of_frequency) {
  const SampleCoordinates at = rows_at(20, {1.1e9, 1.4e9, 1.9e9});
  std::vector<Source> sources = some_sources(7);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    sources[i].spectral_index = std::array{-0.7, 0.0, 1.2}[i % 3];
    sources[i].reference_hz = i % 2 == 0 ? 1.4e9 : 1e9;
  }
  const auto visibility = predict_sources(sources, at, 2);
  for (std::size_t c = 0; c < at.channels(); ++c) {
    std::vector<Source> flat = sources;
    for (Source& source : flat) {
      source.flux_jy *= std::pow(at.frequency_hz[c] / source.reference_hz, source.spectral_index);
      source.spectral_index = 0;
    }
    const auto should = predict_sources(flat, at, 2);
    for (std::size_t row = 0; row < at.rows(); ++row)  // of 7 sources of 1 Jy, to the rounding of recurrences
      BOOST_TEST(std::abs(visibility[row * at.channels() + c] - should[row * at.channels() + c]) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(a_source_in_the_centre_has_the_same_visibility_everywhere) {
  const SampleCoordinates at = rows_at(20, even_channels(64, 1.4e9, 2e6));
  for (const Complex& v : predict_sources({{{0, 0}, 2.5}}, at, 1)) BOOST_TEST(v == Complex(2.5));
}

BOOST_AUTO_TEST_CASE(a_gaussian_falls_to_half_where_its_definition_says_and_to_nothing_beyond) {
  const double fwhm_rad = 1e-4;
  const double half_m = 2 * std::log(2.0) / (pi * fwhm_rad) * speed_of_light_m_s / 1e9;
  for (const double angle : {0.0, 0.7, 2.0}) {
    SampleCoordinates at;
    at.frequency_hz = {1e9, 2e9, 1e11};
    at.uvw_m = {half_m * std::cos(angle), half_m * std::sin(angle), 300};
    const auto v = predict_sources({{{0, 0}, 3, fwhm_rad}}, at, 1);
    BOOST_TEST(std::abs(v[0] - 1.5) < 1e-14);
    BOOST_TEST(std::abs(v[1] - 3.0 / 16) < 1e-14);  // twice as far: the fourth power
    BOOST_TEST(v[2] == Complex(0));
  }
}

BOOST_AUTO_TEST_CASE(a_gaussian_is_its_image_sampled_in_pixels_where_w_is_left_out) {
  const ImageGeometry geometry{96, 80, 2e-5, {}};
  const double fwhm_rad = 6.3 * geometry.cell_rad;
  const DirectionCosines centre{3.3 * geometry.cell_rad, -5.8 * geometry.cell_rad};
  Image image(geometry.width, geometry.height);
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column) {
      const auto [l, m] = geometry.at(row, column);
      const double r2 = (std::pow(l - centre.l, 2) + std::pow(m - centre.m, 2)) / (fwhm_rad * fwhm_rad);
      const double peak = 2.5 * 4 * std::log(2.0) / pi * std::pow(geometry.cell_rad / fwhm_rad, 2);
      image.at(row, column) = peak * std::exp(-4 * std::log(2.0) * r2);
    }
  SampleCoordinates at = rows_at(50, {1e9});
  // All over |u|, |v| < 1/(4 cell), where what sampling folds back has fallen to exp(−(3/4 · 6.3 π)² / (4 ln 2)) = 4e-35;
  // beyond the image's border the Gaussian has fallen to 2^(−4 · (34/6.3)²) = 1e-35. So only rounding is left.
  for (double& x : at.uvw_m.edit()) x *= 0.25 / geometry.cell_rad * speed_of_light_m_s / 1e9 / 2.1e4;
  const auto of_image = DirectTransform({geometry, false, 2}).predict(image)->at(at);
  const auto of_source = predict_sources({{centre, 2.5, fwhm_rad}}, at, 1, false);
  for (std::size_t i = 0; i < of_image.size(); ++i) BOOST_TEST(std::abs(of_image[i] - of_source[i]) < 1e-12);
}

BOOST_AUTO_TEST_CASE(w_over_the_source_itself_costs_what_its_definition_says) {
  const ImageGeometry geometry{96, 96, 2e-5, {}};
  const double fwhm_rad = 10 * geometry.cell_rad;
  Image image(geometry.width, geometry.height);
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column) {
      const auto [l, m] = geometry.at(row, column);
      image.at(row, column) = std::exp(-4 * std::log(2.0) * (l * l + m * m) / (fwhm_rad * fwhm_rad));
    }
  const double flux_jy = std::accumulate(image.pixel.begin(), image.pixel.end(), 0.0);
  SampleCoordinates at;
  at.frequency_hz = {speed_of_light_m_s};  // metres are wavelengths
  const double w = 1e5;
  at.uvw_m = {0, 0, w, 3000, -1000, w};
  const auto of_image = DirectTransform({geometry, true, 2}).predict(image)->at(at);
  const auto of_source = predict_sources({{{0, 0}, flux_jy, fwhm_rad}}, at, 1);
  const double stated = pi * w * fwhm_rad * fwhm_rad / (4 * std::log(2.0));
  for (std::size_t i = 0; i < 2; ++i) {
    const double part = std::abs(of_image[i] / of_source[i] - 1.0);
    // The first is stated/√(1 + stated²), stated being 0.0045; the Gaussian's fall of 0.5 e-folds changes the second by that
    // much.
    BOOST_TEST((part > 0.3 * stated && part < 1.1 * stated));
  }
}

BOOST_AUTO_TEST_CASE(w_is_left_out_where_it_is_not_wanted) {
  const SampleCoordinates at = rows_at(20, {1.4e9, 1.5e9});
  SampleCoordinates flat = at;
  for (std::size_t row = 0; row < flat.rows(); ++row) flat.uvw_m.edit()[3 * row + 2] = 0;
  const std::vector<Source> sources = some_sources(20);
  BOOST_TEST((predict_sources(sources, at, 1, false) == predict_sources(sources, flat, 1)));
  BOOST_TEST((predict_sources(sources, at, 1, false) != predict_sources(sources, at, 1)));
}

BOOST_AUTO_TEST_CASE(threads_change_no_bit) {
  const SampleCoordinates at = rows_at(300, even_channels(70, 1.4e9, 2e6));
  const std::vector<Source> sources = some_sources(50);
  BOOST_TEST((predict_sources(sources, at, 1) == predict_sources(sources, at, 5)));
}

BOOST_AUTO_TEST_CASE(no_sources_give_zeros_and_no_samples_nothing) {
  BOOST_TEST((predict_sources({}, rows_at(3, {1e9, 2e9}), 2) == std::vector<Complex>(6)));
  BOOST_TEST(predict_sources(some_sources(3), rows_at(0, {1e9}), 2).empty());
  BOOST_TEST(predict_sources(some_sources(3), rows_at(4, {}), 2).empty());
}

BOOST_AUTO_TEST_SUITE_END()
