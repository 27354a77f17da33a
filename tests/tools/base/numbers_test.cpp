#include "tools/base/numbers.h"

#include <boost/test/unit_test.hpp>
#include <limits>
#include <numbers>

BOOST_AUTO_TEST_SUITE(numbers)

using namespace misfit::tools;

BOOST_AUTO_TEST_CASE(significant_digits_are_kept_and_trailing_zeros_are_not) {
  BOOST_TEST(significant(0, 3) == "0");
  BOOST_TEST(significant(1.5, 3) == "1.5");
  BOOST_TEST(significant(-0.0312345, 3) == "−0.0312");
  BOOST_TEST(significant(9.996, 3) == "10");
  BOOST_TEST(significant(1024, 2) == "1000");
  BOOST_TEST(significant(1.23e-7, 2) == "1.2e-07");
  BOOST_TEST(significant(2e9, 4) == "2e+09");
  BOOST_TEST(significant(std::numeric_limits<double>::quiet_NaN(), 3) == "not finite");
}

BOOST_AUTO_TEST_CASE(powers_of_ten_are_written_out_and_do_not_break) {
  BOOST_TEST(power_of_ten(3.24e-7, 2) == "3.2\u00a0×\u00a010⁻⁷");
  BOOST_TEST(power_of_ten(-2.488e12, 4) == "−2.488\u00a0×\u00a010¹²");
  BOOST_TEST(power_of_ten(9.99e-7, 2) == "10⁻⁶");
  BOOST_TEST(power_of_ten(315.4, 3) == "315");
}

BOOST_AUTO_TEST_CASE(groups_have_three_digits) {
  BOOST_TEST(grouped(7) == "7");
  BOOST_TEST(grouped(123) == "123");
  BOOST_TEST(grouped(1234567) == "1\u2009234\u2009567");
  BOOST_TEST(grouped(-123456) == "-123\u2009456");
}

BOOST_AUTO_TEST_CASE(whole_numbers_are_listed_in_runs) {
  BOOST_TEST(in_runs({}) == "");
  BOOST_TEST(in_runs({7}) == "7");
  BOOST_TEST(in_runs({4, 3}) == "3 and 4");
  BOOST_TEST(in_runs({0, 1, 2, 3}) == "0 to 3");
  BOOST_TEST(in_runs({9, 0, 2, 1, 2, 5, 6, 10, 11}) == "0 to 2, 5, 6 and 9 to 11");
}

BOOST_AUTO_TEST_CASE(durations_have_the_unit_a_reader_wants) {
  BOOST_TEST(duration(0.0351) == "35 ms");
  BOOST_TEST(duration(4.207) == "4.21 s");
  BOOST_TEST(duration(125) == "2 min 05 s");
  BOOST_TEST(duration(3 * 3600 + 7 * 60 + 12) == "3 h 07 min");
}

BOOST_AUTO_TEST_CASE(units_scale_with_what_they_measure) {
  BOOST_TEST(scaled_unit(0, "Jy").name == "Jy");
  BOOST_TEST(scaled_unit(-0.002, "Jy").name == "mJy");
  BOOST_TEST(scaled_unit(5e-5, "Jy/beam").name == "µJy/beam");
  BOOST_TEST(scaled_unit(1e-12, "Jy").name == "nJy");
  BOOST_TEST(angle_unit(1.0).name == "deg");
  BOOST_TEST(angle_unit(2.5e-4).name == "arcsec");
  BOOST_TEST(angle_unit(1e-8).name == "mas");
}

BOOST_AUTO_TEST_CASE(directions_round_without_sixty_seconds) {
  constexpr double degree = std::numbers::pi / 180;
  BOOST_TEST(sexagesimal({187.7 * degree, -0.5 * degree, "FK5"}) == "12h 30m 48.000s  −00° 30′ 00.00″");
  BOOST_TEST(sexagesimal({-1e-12, 59.9999999 / 3600 * degree, "FK5"}) == "00h 00m 00.000s  +00° 01′ 00.00″");
}

BOOST_AUTO_TEST_SUITE_END()
