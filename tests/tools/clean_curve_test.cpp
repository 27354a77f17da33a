#include "tools/clean_curve.h"

#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(clean_curve)

BOOST_AUTO_TEST_CASE(equal_ratios_of_peaks_are_equal_steps_down) {
  const std::string curve = misfit::tools::clean_curve({{0, 1.0}, {50, 0.1}, {100, 0.01}});
  BOOST_TEST(curve.find("points=\"10,24 200,74 390,124 \"") != std::string::npos);
  BOOST_TEST(curve.find("100 iterations") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(there_is_no_curve_without_three_different_points) {
  BOOST_TEST(misfit::tools::clean_curve({}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{0, 1.0}, {50, 0.1}}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{0, 1.0}, {50, 1.0}, {100, 1.0}}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{0, 1.0}, {50, 0.0}, {100, 0.1}}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
