#include "imager/numerics/phasors.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

BOOST_AUTO_TEST_SUITE(phasors)

namespace bdata = boost::unit_test::data;

BOOST_DATA_TEST_CASE(they_are_the_sine_and_cosine_of_the_part_beyond_whole_turns, bdata::make({1e-9, 0.3, 2.0, 1e3, 1e9}),
                     largest) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-largest, largest);
  std::vector<double> turns{0, 0.125, -0.125, 0.25, -0.25, 0.375, 0.5, -0.5, 0.75, 1, 1.5};
  while (turns.size() < 1003) turns.push_back(uniform(random));
  std::vector<double> cosine(turns.size()), sine(turns.size());
  misfit::imager::phasors(turns.data(), static_cast<int>(turns.size()), cosine.data(), sine.data());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(turns[i] - std::round(turns[i]));
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    BOOST_TEST(std::abs(cosine[i] - static_cast<double>(std::cos(angle))) < rounding);
    BOOST_TEST(std::abs(sine[i] - static_cast<double>(std::sin(angle))) < rounding);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_number_has_no_phase) {
  const double turns = std::numeric_limits<double>::quiet_NaN();
  double cosine = 0, sine = 0;
  misfit::imager::phasors(&turns, 1, &cosine, &sine);
  BOOST_TEST(std::isnan(cosine));
  BOOST_TEST(std::isnan(sine));
}

BOOST_AUTO_TEST_SUITE_END()
