#include "tools/drawing/ticks.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(ticks)

using namespace misfit::tools;

BOOST_AUTO_TEST_CASE(steps_are_one_two_or_five_and_near_what_was_asked) {
  for (double rough = 1e-7; rough < 1e7; rough *= 1.03) {
    const double step = round_step(rough);
    BOOST_TEST(step / rough <= 5 / 3.0 * (1 + 1e-12));  // from 3 to 5 is the longest way up, from 3 to 2 and from 1.5 to 1 down
    BOOST_TEST(step / rough > 2 / 3.0 * (1 - 1e-12));
    const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    BOOST_TEST((std::abs(leading - 1) < 1e-9 || std::abs(leading - 2) < 1e-9 || std::abs(leading - 5) < 1e-9));
  }
}

BOOST_AUTO_TEST_CASE(linear_ticks_are_the_multiples_between_the_limits) {
  const std::vector<double> ticks = linear_ticks(-0.2, 0.4, 6);
  BOOST_TEST_REQUIRE(ticks.size() == 7U);
  for (std::size_t k = 0; k < 7; ++k) BOOST_TEST(std::abs(ticks[k] - 0.1 * (static_cast<double>(k) - 2)) < 1e-15);
}

BOOST_AUTO_TEST_CASE(logarithmic_ticks_are_neither_crowded_nor_lonely) {
  BOOST_TEST((logarithmic_ticks(1e-3, 10) == std::vector<double>{1e-3, 1e-2, 1e-1, 1, 10}));
  BOOST_TEST((logarithmic_ticks(1.5, 30) == std::vector<double>{2, 5, 10, 20}));
  BOOST_TEST((logarithmic_ticks(0.021, 0.049) == linear_ticks(0.021, 0.049, 5)));
  for (double decades = 0.02; decades < 40; decades *= 1.2) {
    for (const double low : {3e-9, 2.1e-2, 8.7}) {
      const std::vector<double> ticks = logarithmic_ticks(low, low * std::pow(10, decades));
      BOOST_TEST(ticks.size() >= 3U);
      BOOST_TEST(ticks.size() <= 8U);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
