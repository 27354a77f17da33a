#include "imager/beams/primary_beam.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "imager/beams/airy_pattern.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(primary_beam)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

constexpr double hz = 1.5e9, wavelength_m = speed_of_light_m_s / hz;
/// A dish, and its pattern.
struct Lit : Dish {
  Pattern pattern = airy_pattern(*this);
  operator Pattern() const { return pattern; }
};

const Lit plain{{25, 0}}, blocked{{25, 2.36}}, large{{12, 0.75}}, small{{7, 0.75}};

PrimaryBeam alone(const Pattern& pattern) {
  return PrimaryBeam({{pattern, pattern, hz, 1}});
}

/// ∫ f over [from, to], by Simpson's rule on 2000 intervals: right to 1e-11 for functions that turn a few times.
double integral(double from, double to, const std::function<double(double)>& f) {
  constexpr int intervals = 2000;
  const double step = (to - from) / intervals;
  double sum = f(from) + f(to);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(from + i * step);
  return sum * step / 3;
}

/// The beam's angle to a pixel, from unit vectors.
double angle(DirectionCosines a, DirectionCosines b) {
  const auto n = [](DirectionCosines at) { return std::sqrt(1 - at.l * at.l - at.m * at.m); };
  const double dot = a.l * b.l + a.m * b.m + n(a) * n(b);
  const double x = a.m * n(b) - n(a) * b.m, y = n(a) * b.l - a.l * n(b), z = a.l * b.m - a.m * b.l;
  return std::atan2(std::hypot(x, y, z), dot);
}

}  // namespace

BOOST_AUTO_TEST_CASE(two_dishes_see_the_product_of_their_voltages_and_pairs_the_mean_by_weight) {
  const auto voltage = [](const Dish& dish, double sine) { return airy_voltage(dish, sine / wavelength_m); };
  const PrimaryBeam mixed({{large, small, hz, 3}, {large, large, hz, 4}, {small, small, hz, 1}, {large, plain, hz, 0}});
  for (const double sine : {0.0, 0.003, 0.01, 0.02, 0.3}) {
    const double a = voltage(large, sine), b = voltage(small, sine);
    BOOST_TEST(std::abs(PrimaryBeam({{large, small, hz, 7}}).power(sine) - a * b) < 1e-14);
    BOOST_TEST(std::abs(mixed.power(sine) - (3 * a * b + 4 * a * a + b * b) / 8) < 1e-14);
  }
  BOOST_TEST(mixed.shares().size() == 3U);
}

BOOST_AUTO_TEST_CASE(a_band_is_the_mean_over_its_frequencies) {
  std::vector<BeamShare> band;
  constexpr int channels = 4000;
  for (int c = 0; c < channels; ++c) {
    const double x = (c + 0.5) / channels;
    band.push_back({blocked, blocked, 1e9 * (1 + x), 1 + x * x});
  }
  const PrimaryBeam beam(band);
  BOOST_TEST(beam.shares().size() < 750U);  // of a thousandth each, ln 2 / 0.001
  for (const double sine : {0.002, 0.005, 0.0065, 0.009}) {
    const double mean = integral(0, 1, [sine](double x) {
      return (1 + x * x) * std::pow(airy_voltage(blocked, sine * 1e9 * (1 + x) / speed_of_light_m_s), 2);
    });
    BOOST_TEST(std::abs(beam.power(sine) - mean * 3 / 4) < 1e-6);  // what taking frequencies together may change
  }
}

BOOST_DATA_TEST_CASE(pixels_hold_the_beam_at_their_true_angle_from_the_axis,
                     bdata::make({0.0, 0.4, 0.97}) * bdata::make({1.5e9, 4e7}), away, frequency_hz) {
  const PrimaryBeam beam({{blocked, blocked, frequency_hz, 1}, {plain, small, frequency_hz * 1.1, 0.5}});
  const DirectionCosines pointing{away * 0.6, -away * 0.8};
  ImageGeometry geometry{61, 40, 0, {}, {pointing.l + 1e-4, pointing.m}};
  geometry.cell_rad = beam.half_power_width_rad() / 30;
  const double limit = 0.2;
  const Image image = primary_beam_image(beam, geometry, {pointing, limit, 2});
  int seen = 0;
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column) {
      const DirectionCosines at = geometry.at(row, column);
      const double value = image.at(row, column);
      const double theta = beyond_horizon(at) ? pi : angle(at, pointing);
      const double expected = theta < pi / 2 ? beam.power(std::sin(theta)) : 0;
      if (std::abs(expected - limit) < 1e-8) continue;
      BOOST_TEST(std::isnan(value) == (expected < limit));
      if (std::isnan(value)) continue;
      ++seen;
      BOOST_TEST(std::abs(value - expected) < 1e-9);
    }
  BOOST_TEST(seen > 300);  // of 1400 within the limit where an image has them all; far away they are foreshortened
}

BOOST_AUTO_TEST_CASE(sidelobes_have_no_value_whatever_the_limit) {
  const PrimaryBeam beam = alone(plain);
  const ImageGeometry geometry{401, 1, 0.01 * wavelength_m / 25, {}};
  const Image image = primary_beam_image(beam, geometry, {{}, 0.001, 1});
  const double edge = beam.sine_at(0.001);
  BOOST_TEST(edge < 1.2197 * wavelength_m / 25);
  for (int column = 0; column < 401; ++column)
    BOOST_TEST(std::isnan(image.at(0, column)) == (std::abs(geometry.l(column)) > edge));
}

BOOST_AUTO_TEST_CASE(an_image_is_divided_by_its_beam_and_keeps_no_value_where_that_has_none) {
  Image image(2, 1), beam(2, 1);
  image.pixel = {3, 4};
  beam.pixel = {0.5, std::nan("")};
  const Image quotient = corrected(image, beam);
  BOOST_TEST(quotient.pixel[0] == 6.0);
  BOOST_TEST(std::isnan(quotient.pixel[1]));
  BOOST_CHECK_THROW(corrected(image, Image(1, 2)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(what_is_no_beam_is_refused) {
  for (const BeamShare& wrong : {BeamShare{plain, plain, 0, 1}, BeamShare{plain, plain, hz, -1}, BeamShare{plain, plain, hz, 0},
                                 BeamShare{plain, plain, NAN, 1}})
    BOOST_CHECK_THROW(PrimaryBeam({wrong}), std::invalid_argument);
  BOOST_CHECK_THROW(PrimaryBeam({}), std::invalid_argument);
  for (const double limit : {0.0, 1.0, -0.2, std::nan("")})
    BOOST_CHECK_THROW(primary_beam_image(alone(plain), {1, 1, 1e-5, {}}, {{}, limit, 1}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
