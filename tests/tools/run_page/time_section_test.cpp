#include "tools/run_page/time_section.h"

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(time_section)

using misfit::tools::testing::balanced;
using misfit::tools::testing::contains;
using nlohmann::json;

namespace {

const json measured{{"read", 0.5}, {"grid", 1.0}, {"total", 2.0}};

std::string cell(const std::string& text) {
  return "<td class=\"number\">" + text + "</td>";
}

std::vector<double> values_of(const std::string& html, const std::string& attribute) {
  std::vector<double> values;
  const std::string before = " " + attribute + "=\"";
  for (std::size_t at = html.find("<rect"); at != std::string::npos; at = html.find("<rect", at + 1))
    values.push_back(std::stod(html.substr(html.find(before, at) + before.size())));
  return values;
}

}  // namespace

BOOST_AUTO_TEST_CASE(times_are_shares_of_the_wall_clock) {
  const std::string html = misfit::tools::time_section(measured, nullptr);
  BOOST_TEST(balanced(html));
  BOOST_TEST(contains(html, "grid</td>" + cell("1 s") + cell("50 %")));
  BOOST_TEST(contains(html, "everything else</td>" + cell("500 ms") + cell("25 %")));
  BOOST_TEST(contains(html, "<b>wall clock</b></td>" + cell("<b>2 s</b>")));
}

BOOST_AUTO_TEST_CASE(the_parts_of_the_bar_lie_end_to_end_and_fill_it) {
  const std::string html = misfit::tools::time_section(measured, nullptr);
  const std::vector<double> from = values_of(html, "x"), width = values_of(html, "width");
  BOOST_TEST(from == (std::vector<double>{0, 500, 750}), boost::test_tools::per_element());
  BOOST_TEST(width == (std::vector<double>{500, 250, 250}), boost::test_tools::per_element());
  BOOST_TEST(contains(html, "<title>grid: 1 s, 50 %</title>"));
}

BOOST_AUTO_TEST_CASE(what_was_expected_stands_beside_what_was_measured) {
  const json expected{{"grid", 0.8}, {"fft", 0.01}, {"total", 1.5}};
  const std::string html = misfit::tools::time_section(measured, expected);
  BOOST_TEST(contains(html, "grid</td>" + cell("1 s") + cell("800 ms") + cell("50 %")));
  BOOST_TEST(contains(html, "read</td>" + cell("500 ms") + cell("") + cell("25 %")));
  BOOST_TEST(contains(html, "fft</td>" + cell("0 ms") + cell("10 ms") + cell("0 %")));
  BOOST_TEST(contains(html, "<b>wall clock</b></td>" + cell("<b>2 s</b>") + cell("<b>1.5 s</b>")));
  BOOST_TEST(!contains(misfit::tools::time_section(measured, nullptr), "Expected"));
}

BOOST_AUTO_TEST_CASE(many_stages_share_the_last_colour) {
  json many;
  for (int k = 0; k < 20; ++k) many["stage " + std::to_string(k)] = 1 + k;
  const std::string html = misfit::tools::time_section(many, nullptr);
  BOOST_TEST(contains(html, "<rect class=\"s7\""));
  BOOST_TEST(!contains(html, "\"s8\""));
}

BOOST_AUTO_TEST_CASE(without_times_there_is_nothing) {
  BOOST_TEST(misfit::tools::time_section(nullptr, nullptr) == "");
  BOOST_TEST(misfit::tools::time_section(json::object(), {{"grid", 1.0}}) == "");
}

BOOST_AUTO_TEST_SUITE_END()
