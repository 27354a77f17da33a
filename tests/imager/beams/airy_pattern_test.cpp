#include "imager/beams/airy_pattern.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "imager/beams/primary_beam.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(airy_pattern)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

constexpr double hz = 1.5e9, wavelength_m = speed_of_light_m_s / hz;
const Dish plain{25, 0}, blocked{25, 2.36}, large{12, 0.75}, small{7, 0.75};

PrimaryBeam alone(const Dish& dish) {
  const Pattern pattern = misfit::imager::airy_pattern(dish);
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

}  // namespace

BOOST_DATA_TEST_CASE(a_voltage_is_the_transform_of_the_lit_ring, bdata::make({0.0, 0.3, 2.36, 12.0}), blockage_m) {
  const Dish dish{25, blockage_m};
  const double b = blockage_m / 25;
  for (const double x : {0.0, 1e-3, 0.0099, 0.0101, 0.5, 1.6, 3.8, 7.0, 25.0}) {
    const double ring = integral(b, 1, [x](double r) { return r * std::cyl_bessel_j(0, x * r); }) * 2 / (1 - b * b);
    BOOST_TEST(std::abs(airy_voltage(dish, x / (pi * 25)) - ring) < 1e-10);  // what the rule errs by at x = 25
  }
}

BOOST_AUTO_TEST_CASE(an_unblocked_dish_has_the_airy_discs_half_power_and_null) {
  BOOST_TEST(airy_voltage(plain, 0) == 1.0);
  // Zeros of J₁(x)/x − √⅛ and of J₁, over π.
  const double half = 1.61633995 / pi, null = 3.83170597 / pi;
  BOOST_TEST(std::abs(alone(plain).sine_at(0.5) - half * wavelength_m / 25) < 1e-8 * wavelength_m);
  BOOST_TEST(std::abs(airy_voltage(plain, null / 25)) < 1e-8);
  BOOST_TEST(std::abs(alone(plain).half_power_width_rad() - 1.02899 * wavelength_m / 25) <
             1e-4 * wavelength_m / 25);  // and arc sines, 1e-5 here
}

BOOST_AUTO_TEST_CASE(the_main_lobe_ends_where_the_voltage_is_first_0) {
  for (const double diameter_m : {0.5, 25.0, 300.0})
    for (const double part : {0.0, 0.1, 0.5, 0.99}) {
      const Dish dish{diameter_m, part * diameter_m};
      const double null = first_null_per_m(dish);
      BOOST_TEST(std::abs(airy_voltage(dish, null)) < 1e-12);
      for (double s = 0; s < 0.99 * null; s += null / 50) BOOST_TEST(airy_voltage(dish, s) > 0);
    }
  BOOST_TEST(std::abs(first_null_per_m(plain) * 25 - 1.219670) < 1e-6);
  const Pattern of_large = misfit::imager::airy_pattern(large), of_small = misfit::imager::airy_pattern(small);
  const PrimaryBeam mixed({{of_large, of_small, hz, 3}, {of_large, of_large, 2 * hz, 4}});
  BOOST_TEST(mixed.main_lobe_sine() == first_null_per_m(small) * wavelength_m);
  BOOST_TEST(alone({0.1, 0}).main_lobe_sine() == 1.0);  // smaller than the wavelength
}

BOOST_AUTO_TEST_CASE(blockage_narrows_the_lobe_and_raises_the_next) {
  BOOST_TEST(alone(blocked).half_power_width_rad() < alone(plain).half_power_width_rad());
  const auto highest_sidelobe = [](const Dish& dish) {
    double highest = 0;
    for (double s = 1.25; s < 2.2; s += 0.001) highest = std::max(highest, std::pow(airy_voltage(dish, s / 25), 2));
    return highest;
  };
  BOOST_TEST(std::abs(highest_sidelobe(plain) - 0.017498) < 1e-6);  // of the Airy disc
  BOOST_TEST(highest_sidelobe(blocked) > highest_sidelobe(plain));
}

BOOST_AUTO_TEST_CASE(dishes_that_are_none_are_refused) {
  for (const Dish& dish : {Dish{0, 0}, Dish{-1, 0}, Dish{25, 25}, Dish{25, -1}, Dish{INFINITY, 0}, Dish{NAN, 0}})
    BOOST_CHECK_THROW(misfit::imager::airy_pattern(dish), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
