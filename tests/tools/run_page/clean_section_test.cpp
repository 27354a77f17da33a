#include "tools/run_page/clean_section.h"

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(clean_section)

using misfit::tools::testing::contains;
using nlohmann::json;

namespace {

json cycle(int iterations, double peak, double noise, double flux, double depth) {
  return {{"iterations", iterations},
          {"peak_residual_jy", peak},
          {"rms_jy", noise},
          {"model_flux_jy", flux},
          {"cycle_threshold_jy", depth}};
}

json report() {
  return {
      {"iterations", 80},
      {"major_cycles", 2},
      {"stop_code", 1},
      {"stop_reason", "done"},
      {"model_flux_jy", 1.75},
      {"kept_cycle", 2},
      {"major_cycles_log", {cycle(0, 1, 0.1, 0.5, 0), cycle(50, -0.2, 0.02, 1.5, 0.25), cycle(80, 0.05, 0.004, 1.75, 0.06)}}};
}

/// The cells of a table's row, from its first.
std::string row(std::initializer_list<const char*> cells) {
  std::string text = "<tr>";
  for (const char* content : cells) text.append("<td class=\"number\">").append(content).append("</td>");
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_cycle_found_and_cleaned_what_it_has_more_than_the_one_before) {
  const std::string page = misfit::tools::clean_section(report());
  BOOST_TEST(contains(page, row({"start", "0", "", "", "1000", "100", "0.5", ""})));
  BOOST_TEST(contains(page, row({"1", "50", "50", "250", "200", "20", "1.5", "1"})));
  BOOST_TEST(contains(page, row({"2", "80", "30", "60", "50", "4", "1.75", "0.25"})));
  BOOST_TEST(contains(page, "Depth<small>mJy/beam</small>"));
  BOOST_TEST(contains(page, "Cleaned<small>Jy</small>"));
}

BOOST_AUTO_TEST_CASE(why_cycles_ended_is_said_where_it_is_known) {
  json clean = report();
  BOOST_TEST(!contains(misfit::tools::clean_section(clean), "ended because"));
  clean["major_cycles_log"][0]["ended"] = "";
  clean["major_cycles_log"][1]["ended"] = "it was <deep> enough";
  const std::string page = misfit::tools::clean_section(clean);
  BOOST_TEST(contains(page, "ended because"));
  BOOST_TEST(contains(page, "<td class=\"number\">1</td><td>it was &lt;deep&gt; enough</td>"));
}

BOOST_AUTO_TEST_CASE(a_model_kept_from_an_earlier_cycle_is_marked) {
  json clean = report();
  BOOST_TEST(!contains(misfit::tools::clean_section(clean), "kept"));
  clean["kept_cycle"] = 1;
  BOOST_TEST(contains(misfit::tools::clean_section(clean), "<td class=\"number\">1 <b>kept</b></td>"));
}

BOOST_AUTO_TEST_CASE(what_is_not_known_of_one_cycle_is_not_known_of_its_gain) {
  json clean = report();
  clean["major_cycles_log"][1]["model_flux_jy"] = nullptr;
  const std::string page = misfit::tools::clean_section(clean);
  const std::string none = "<span class=\"none\">not measured</span>";
  BOOST_TEST(contains(page, row({"2", "80", "30", "60", "50", "4", "1.75", none.c_str()})));
}

BOOST_AUTO_TEST_CASE(without_clean_there_is_nothing) {
  BOOST_TEST(misfit::tools::clean_section(nullptr).empty());
  BOOST_TEST(misfit::tools::clean_progress(nullptr).empty());
  BOOST_TEST(misfit::tools::clean_progress(report()).starts_with("<svg"));
}

BOOST_AUTO_TEST_SUITE_END()
