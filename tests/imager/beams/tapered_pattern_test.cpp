#include "imager/beams/tapered_pattern.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(tapered_pattern)

using namespace misfit::imager;

namespace {

constexpr double arcmin = pi / 180 / 60;

double power(const Pattern& pattern, double theta_rad, double hz) {
  return std::pow(pattern->voltage(std::sin(theta_rad), hz), 2);
}

}  // namespace

/// The formula as it is printed (Mauch et al. 2020, equation 3), away from where it is 0/0.
BOOST_AUTO_TEST_CASE(a_cosine_tapered_field_is_the_published_formula) {
  const Pattern meerkat = cosine_tapered_pattern(57.5 * 1.5);
  for (const double hz : {0.9e9, 1.5e9, 3e9})
    for (double rho = 0; rho < 3; rho += 0.0371) {
      const double x = 1.189 * rho, theta = rho * 57.5 * arcmin * 1.5e9 / hz;
      const double voltage = std::cos(pi * x) / (1 - 4 * x * x);
      BOOST_TEST(std::abs(meerkat->voltage(std::sin(theta), hz) - voltage) < 1e-11, rho);
    }
  BOOST_TEST(std::abs(meerkat->voltage(std::sin(0.5 / 1.189 * 57.5 * arcmin), 1.5e9) - pi / 4) < 1e-9);  // at 0/0
  BOOST_TEST(std::abs(power(meerkat, 57.5 / 2 * arcmin, 1.5e9) - 0.5) < 1e-3);
  const double null = meerkat->main_lobe_sine(1.5e9);
  BOOST_TEST(std::abs(meerkat->voltage(null, 1.5e9)) < 1e-12);
  BOOST_TEST(meerkat->voltage(1.05 * null, 1.5e9) < 0);
}

/// cos⁶(β ν θ) with ν in MHz and the angles in degrees, β 0.0629 below 800 MHz and 0.065 above.
BOOST_AUTO_TEST_CASE(a_cubed_cosine_is_the_published_formula) {
  const Pattern wsrt = cosine_cubed_pattern(0.0629, 0.065, 800e6);
  for (const double degrees : {0.0, 0.1, 0.3, 0.7}) {
    BOOST_TEST(std::abs(power(wsrt, degrees * pi / 180, 350e6) - std::pow(std::cos(0.0629 * 350 * degrees * pi / 180), 6)) <
               1e-12);
    BOOST_TEST(std::abs(power(wsrt, degrees * pi / 180, 1400e6) - std::pow(std::cos(0.065 * 1400 * degrees * pi / 180), 6)) <
               1e-12);
  }
  BOOST_TEST(wsrt->voltage(1.01 * wsrt->main_lobe_sine(1.4e9), 1.4e9) == 0.0);
}

BOOST_AUTO_TEST_CASE(a_gaussian_is_a_half_at_half_its_width_and_ends_at_a_thousandth) {
  const Pattern askap = gaussian_pattern(1.09, 12);
  for (const double hz : {0.8e9, 1.4e9}) {
    const double width = 1.09 * speed_of_light_m_s / hz / 12;
    for (const double part : {0.0, 0.25, 0.5, 1.0})
      BOOST_TEST(std::abs(power(askap, part * width, hz) - std::exp(-4 * std::log(2.0) * part * part)) < 1e-12);
    const double end = askap->main_lobe_sine(hz);
    BOOST_TEST(std::abs(std::pow(askap->voltage(0.999999 * end, hz), 2) - 1e-3) < 1e-7);
    BOOST_TEST(askap->voltage(1.000001 * end, hz) == 0.0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
