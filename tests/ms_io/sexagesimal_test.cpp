#include "ms_io/sexagesimal.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

BOOST_AUTO_TEST_SUITE(sexagesimal)

using namespace misfit::ms_io;

namespace {

constexpr double degree = M_PI / 180;

struct Form {
  const char* written;
  Colons colons;
  double unit_rad;
  Parts parts = Parts::all;
};
const std::vector<Form> forms{
    {"%s%dh%dm%ss", Colons::degrees, 15 * degree}, {"%s%dh%02dm%s", Colons::degrees, 15 * degree, Parts::some},
    {"%s%02d:%d:%s", Colons::hours, 15 * degree},  {"%s%d:%02d:%s", Colons::degrees, degree},
    {"%s%03dd%dm%ss", Colons::hours, degree},      {"%s%d.%02d.%s", Colons::hours, degree}};

std::optional<double> read(const std::string& text, const Form& form) {
  return sexagesimal_rad(text, form.colons, form.parts);
}

std::string written(const Form& form, const char* sign, int units, int minutes, const char* seconds) {
  char text[80];
  std::snprintf(text, sizeof text, form.written, sign, units, minutes, seconds);
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_angle_is_the_sum_of_its_parts_with_its_sign) {
  for (const Form& form : forms)
    for (const char* sign : {"", "+", "-"})
      for (const int units : {0, 7, 23})
        for (const int minutes : {0, 9, 59})
          for (const char* seconds : {"0", "7.25", "59.999", "60.00", "60"}) {
            const std::string text = written(form, sign, units, minutes, seconds);
            const double value = units + minutes / 60.0 + std::stod(seconds) / 3600;
            BOOST_TEST_CONTEXT(text) {
              BOOST_TEST(is_sexagesimal(text));
              const auto angle_rad = read(text, form);
              BOOST_REQUIRE(angle_rad.has_value());
              // Both sums round by a few parts in 1e16.
              BOOST_TEST(std::abs(*angle_rad - (*sign == '-' ? -1 : 1) * value * form.unit_rad) <=
                         1e-15 * (1 + std::abs(*angle_rad)));
            }
          }
}

BOOST_AUTO_TEST_CASE(sixty_seconds_are_the_next_minute_to_the_bit) {
  for (const Form& form : forms)
    for (const int minutes : {0, 30, 58})
      BOOST_TEST(*read(written(form, "-", 12, minutes, "60.00"), form) ==
                 *read(written(form, "-", 12, minutes + 1, "00"), form));
  BOOST_TEST(*sexagesimal_rad("+89d59m60.00s", Colons::hours) == M_PI / 2);  // the pole, and not beyond
  BOOST_TEST(*sexagesimal_rad("23:59:60.0", Colons::hours) == 2 * M_PI);
}

BOOST_AUTO_TEST_CASE(seconds_may_be_left_out_where_that_is_asked_for) {
  const std::vector<std::pair<std::string, double>> partial{
      {"12h30m", 187.5}, {"-12d30m", -12.5}, {"12:30", 12.5}, {"12h30m00", 187.5}, {"12d30m0.0", 12.5}};
  for (const auto& [text, angle_deg] : partial) {
    BOOST_TEST(*sexagesimal_rad(text, Colons::degrees, Parts::some) == angle_deg * degree, text);
    BOOST_TEST(!sexagesimal_rad(text, Colons::degrees), text);
  }
}

BOOST_AUTO_TEST_CASE(parts_that_are_none_make_no_angle) {
  for (const Form& form : forms) {
    for (const char* seconds : {"60.01", "61", "-5", "+5", "1e1", "nan", "5x", ".5", "5 "})
      BOOST_TEST(!read(written(form, "", 12, 30, seconds), form), seconds);
    for (const int minutes : {60, 75, -5}) BOOST_TEST(!read(written(form, "", 12, minutes, "0"), form), minutes);
    for (const char* sign : {"--", "+-", " "}) BOOST_TEST(!read(written(form, sign, 12, 30, "0"), form), sign);
    BOOST_TEST(!read(written(form, "", 361, 0, "0"), form));
  }
  BOOST_TEST(!sexagesimal_rad("24h00m00.1s", Colons::hours));
  for (const char* text : {"12h30", "1:2:3:4", "12.23.28.5.6", "12:30:", "12h:30", "12.30.", "12h30ms"})
    BOOST_TEST(!sexagesimal_rad(text, Colons::hours, Parts::some), text);
}

BOOST_AUTO_TEST_CASE(numbers_with_units_are_none) {
  for (const char* text :
       {"", "-", "12", "12.5", "12.5deg", "12deg", "187.7d", "12d", "12h", "1e3arcsec", "100pix", "h", ".5.5.5"})
    BOOST_TEST(!is_sexagesimal(text), text);
}

BOOST_AUTO_TEST_SUITE_END()
