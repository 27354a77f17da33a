#include "tools/run/outside_stage.h"

#include <boost/test/data/test_case.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "imager/data/noise.h"
#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tools/run_page/outside_section.h"

BOOST_AUTO_TEST_SUITE(outside_stage)

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;
using tools::OutsideReport;

namespace {

constexpr double arcsec = M_PI / 180 / 3600;

OutsideReport report_with(std::size_t sources) {
  OutsideReport report;
  report.field = {100, 100, arcsec, {1, 0.5}};
  report.harmless = {{{{-50 * arcsec, 60 * arcsec}, 3}, 1e-5}, {{{0, 70 * arcsec}, 0.6}, 2e-5}};
  report.least_jy = 0.5;
  report.highest_alias_jy = sources > 0 ? 0.1 : 5e-4;
  report.all_aliases_jy = 1.5 * report.highest_alias_jy;
  report.noise_jy = 1e-3;
  for (std::size_t i = 0; i < sources; ++i)
    report.sources.push_back({{{40 * arcsec, -30 * arcsec}, 2}, 0.1 / static_cast<double>(i + 1)});
  return report;
}

/// With 30 Jy beyond the field, of which three detections may be sidelobes.
OutsideReport report_of_less_than_all(std::size_t sources) {
  OutsideReport report = report_with(sources);
  report.elsewhere = true;
  report.elsewhere_jy = 30;
  report.doubtful = 3;
  return report;
}

json json_of(const OutsideReport* report) {
  return {{"outside", outside_json(report)}, {"outside_search", outside_search_json(report)}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_source_is_told_with_its_position_flux_and_alias) {
  const OutsideReport report = report_with(1);
  const json told = outside_json(&report).at(0);
  BOOST_TEST(told.at("l_arcsec").get<double>() == 40, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(told.at("m_arcsec").get<double>() == -30, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(told.at("flux_jy") == 2);
  BOOST_TEST(told.at("alias_jy") == 0.1);
  // East is 40″ / cos δ more in right ascension, to the curvature of the sky over an arc minute.
  BOOST_TEST(told.at("ra_deg").get<double>() == (1 + 40 * arcsec / std::cos(0.5)) * 180 / M_PI,
             boost::test_tools::tolerance(1e-7));
  BOOST_TEST(told.at("dec_deg").get<double>() == (0.5 - 30 * arcsec) * 180 / M_PI, boost::test_tools::tolerance(1e-7));
  BOOST_TEST(contains(outside_warnings(report).at(0), "40 arcsec east and 30 arcsec south"));
}

BOOST_AUTO_TEST_CASE(every_source_found_is_told_with_its_place_the_brightest_first) {
  const auto lines = outside_places(report_with(1));
  BOOST_REQUIRE(lines.size() == 3U);
  BOOST_TEST(contains(lines[0], "3 Jy at "));
  BOOST_TEST(contains(lines[0], "50 arcsec west and 60 arcsec north of the phase centre; alias 10 µJy/beam at most"));
  BOOST_TEST(contains(lines[1], "2 Jy at "));
  BOOST_TEST(contains(lines[2], "600 mJy at "));
  BOOST_TEST(outside_places(report_with(9)).size() == 11U);
  BOOST_TEST(outside_places(report_with(9)).back() == "  and 1 more, which the report lists");
  const OutsideReport report = report_with(1);
  BOOST_TEST(outside_search_json(&report).at("found") == 3);
  BOOST_TEST(outside_search_json(&report).at("harmless").size() == 2U);
}

BOOST_AUTO_TEST_CASE(three_sources_are_warned_of_and_the_others_counted) {
  BOOST_TEST(outside_warnings(report_with(0)).empty());
  BOOST_TEST(outside_warnings(report_with(3)).size() == 3U);
  const auto warnings = outside_warnings(report_with(9));
  BOOST_TEST(warnings.size() == 3U);
  BOOST_TEST(contains(warnings.back(), "and 6 more"));
}

BOOST_AUTO_TEST_CASE(the_decision_says_how_high_an_alias_is_beside_the_noise_and_whence_that_is_known) {
  OutsideReport report = report_with(0);
  BOOST_TEST(outside_decision(report).decision == "no alias above 1 mJy/beam");
  BOOST_TEST(contains(outside_decision(report).because, "all together 750 µJy/beam"));
  report.all_aliases_jy = 2e-3;
  BOOST_TEST(outside_decision(report).decision == "no single alias above 1 mJy/beam");
  BOOST_TEST(contains(outside_decision(report).because, "the highest alias is 500 µJy/beam at most"));
  BOOST_TEST(contains(outside_decision(report).because, "noise is 1 mJy/beam at most, as its pixels scatter"));
  report.noise_of_pixels = false;
  BOOST_TEST(contains(outside_decision(report).because, "noise is 1 mJy/beam at most, as visibilities scatter"));
  BOOST_TEST(contains(outside_decision(report_with(2)).decision, "2 may show"));
  BOOST_TEST(outside_decision(report_of_less_than_all(0)).decision == "no alias known above 1 mJy/beam");
}

BOOST_AUTO_TEST_CASE(the_plan_says_how_large_and_coarse_the_image_is_that_is_searched_and_why) {
  const imager::Decision told = tools::search_decision({{640, 512, 2 * arcsec, {}}, 0, 0.43}, 1.5);
  BOOST_TEST(told.decision == "640 × 512 pixels of 2 arcsec");
  BOOST_TEST(contains(told.because, "four times the image's field"));
  BOOST_TEST(contains(told.because, "43 % of the samples"));
  BOOST_TEST(contains(told.because, "takes 1.5 s"));
}

BOOST_AUTO_TEST_CASE(where_no_sample_is_short_enough_nothing_is_searched_and_that_is_told) {
  OutsideReport report = report_with(0);
  report.searched = false;
  BOOST_TEST(contains(outside_warnings(report).at(0), "not looked for: no usable sample"));
  BOOST_TEST(outside_decision(report).decision == "not looked for");
  BOOST_TEST(outside_json(&report).is_null());
  BOOST_TEST(tools::outside_section(json_of(&report)).empty());
}

BOOST_AUTO_TEST_CASE(flux_that_is_in_no_source_found_is_warned_of_with_what_may_be_its_sidelobes) {
  const auto warnings = outside_warnings(report_of_less_than_all(1));
  BOOST_REQUIRE(warnings.size() == 2U);
  BOOST_TEST(contains(warnings.back(), "about 30 Jy of flux is in no source that was found"));
  BOOST_TEST(contains(warnings.back(), "3 that were found outside the image with less than 500 mJy may be sidelobes of it"));
  OutsideReport report = report_of_less_than_all(0);
  report.elsewhere = false;
  report.doubtful = 1;
  BOOST_TEST(contains(outside_warnings(report).at(0), "up to 30 Jy"));
  BOOST_TEST(contains(outside_warnings(report).at(0), "1 that was found"));
  report.doubtful = 0;
  BOOST_TEST(outside_warnings(report).empty());
}

BOOST_AUTO_TEST_CASE(a_source_at_the_border_of_the_field_is_told_to_be_there) {
  OutsideReport report = report_with(1);
  BOOST_TEST(!contains(outside_warnings(report).at(0), "border"));
  report.sources.front().at_border = true;
  BOOST_TEST(contains(outside_warnings(report).at(0), "at the border of the field searched or beyond it"));
  BOOST_TEST(contains(tools::outside_section(json_of(&report)), "at the border searched, or beyond"));
}

BOOST_AUTO_TEST_CASE(the_section_has_a_row_for_each_source_and_is_empty_without_a_search) {
  const OutsideReport none = report_with(0), some = report_with(4);
  BOOST_TEST(tools::outside_section(json_of(nullptr)).empty());
  const std::string quiet = tools::outside_section(json_of(&none)), loud = tools::outside_section(json_of(&some));
  BOOST_TEST(!contains(quiet, "<table"));
  BOOST_TEST(contains(quiet, "No alias exceeds"));
  std::size_t rows = 0;
  for (std::size_t at = loud.find("<tr>"); at != loud.npos; at = loud.find("<tr>", at + 1)) ++rows;
  BOOST_TEST(rows == 5U);  // with the headings
  for (const std::string& section : {quiet, loud}) {
    BOOST_TEST(balanced(section));
    BOOST_TEST(contains(section, "sidelobes"));
    BOOST_TEST(!contains(section, "Elsewhere"));
  }
  const OutsideReport less = report_of_less_than_all(4);
  BOOST_TEST(contains(tools::outside_section(json_of(&less)), "Elsewhere:</strong> about 30 Jy"));
}

BOOST_AUTO_TEST_CASE(a_run_reports_the_alias_that_shows_in_its_image_and_none_with_a_good_kernel) {
  const TemporaryFolder folder;
  const std::string sky = folder / "sky.csv", set = folder / "sky.ms";
  // The image is 25.6″ wide: the source lies 1.5 fields east of its middle, its alias 0.4 of one west of it.
  std::ofstream(sky) << "l_arcsec,m_arcsec,flux_jy\n38.4,3,1000\n2,-4,5\n";
  succeed({"simulate", "--output", set, "--sky", sky, "--hours", "1", "--interval", "60", "--noise", "1Jy"});
  const Arguments image{"image", "--vis", set, "--imsize", "256", "--cell", "0.1arcsec", "--check-outside"};
  const Outcome narrow = run(
      image + Arguments{"--imagename", folder / "narrow", "--kernel", "nearest", "--kernel-width", "1", "--padding", "1.9"});
  BOOST_REQUIRE_EQUAL(narrow.code, 0);
  const json told = report_of(folder / "narrow");
  BOOST_REQUIRE(!told.at("outside").empty());
  const json& source = told.at("outside").at(0);
  BOOST_TEST(std::abs(source.at("l_arcsec").get<double>() - 38.4) < 0.4);
  BOOST_TEST(std::abs(source.at("m_arcsec").get<double>() - 3) < 0.4);
  BOOST_TEST(contains(narrow.err + narrow.out, "outside the image, at"));
  BOOST_TEST(contains(content(folder / "narrow.report.html"), "Sources outside the image"));
  succeed(image + Arguments{"--imagename", folder / "good", "--accuracy", "1e-8"});
  const json good = report_of(folder / "good");
  BOOST_TEST(good.at("outside").empty());
  BOOST_TEST(good.at("outside_search").at("found").get<int>() >= 1);
  // The exact image shows what the alias really is.
  const imager::Image bad_image = pixels_of(folder / "narrow", "residual"), good_image = pixels_of(folder / "good", "residual");
  double highest = 0;
  for (std::size_t i = 0; i < bad_image.pixel.size(); ++i)
    highest = std::max(highest, std::abs(bad_image.pixel[i] - good_image.pixel[i]));
  const double alias = source.at("alias_jy").get<double>();
  BOOST_TEST(alias < 2 * highest);
  BOOST_TEST(alias > highest / 2);
}

BOOST_AUTO_TEST_CASE(without_noise_any_alias_counts_that_is_above_what_shallow_cleaning_leaves) {
  const TemporaryFolder folder;
  const std::string sky = folder / "sky.csv", set = folder / "sky.ms";
  std::ofstream(sky) << "l_arcsec,m_arcsec,flux_jy\n38.4,3,1000\n";
  succeed({"simulate", "--output", set, "--sky", sky, "--hours", "1", "--interval", "60"});
  const Arguments image{"image",           "--vis",    set,          "--imsize",       "256", "--cell",    "0.1arcsec",
                        "--check-outside", "--kernel", "spheroidal", "--kernel-width", "4",   "--padding", "1.5",
                        "--quiet"};
  BOOST_REQUIRE_EQUAL(run(image + Arguments{"--imagename", folder / "weak"}).code, 0);
  const json told = report_of(folder / "weak");
  const json& search = told.at("outside_search");
  // The scatter of the pixels is the sidelobes of a thousand Jy, well above the alias. That of visibilities is what CLEAN left
  // of it, a hundredth, as far as it differs within cells: a third of the other leaves room for how CLEAN goes.
  const imager::Image pixels = pixels_of(folder / "weak", "residual");
  BOOST_TEST(search.at("noise_jy").get<double>() < imager::robust_noise(pixels) / 3);
  BOOST_TEST(contains(search.at("noise").get<std::string>(), "visibilities"));
  BOOST_TEST(told.at("outside").size() == 1U);
  BOOST_TEST(search.at("highest_alias_jy").get<double>() < imager::robust_noise(pixels));
}

BOOST_DATA_TEST_CASE(a_source_beyond_the_field_searched_is_not_told_as_one_within,
                     boost::unit_test::data::make({0, 1}) * boost::unit_test::data::make({-140, -200}), hours, l_arcsec) {
  const TemporaryFolder folder;
  const std::string sky = folder / "sky.csv", set = folder / "sky.ms";
  // The image is 64″ wide, the field 256″.
  std::ofstream(sky) << "l_arcsec,m_arcsec,flux_jy\n" << l_arcsec << ",20,100\n3,4,1\n";
  succeed({"simulate", "--output", set, "--sky", sky, "--hours", std::to_string(hours), "--interval", "60", "--array", "vla-c",
           "--noise", "0.01Jy"});
  const Outcome outcome = run({"image", "--vis", set, "--imsize", "128", "--cell", "0.5arcsec", "--check-outside", "--kernel",
                               "nearest", "--kernel-width", "1", "--padding", "1.5", "--imagename", folder / "far"});
  BOOST_REQUIRE_EQUAL(outcome.code, 0);
  const json told = report_of(folder / "far");
  BOOST_TEST(told.at("outside").empty());
  BOOST_TEST(contains(outcome.out + outcome.err, "sources beyond the field searched"));
  BOOST_TEST(told.at("outside_search").at("elsewhere").is_string());
}

BOOST_AUTO_TEST_SUITE_END()
