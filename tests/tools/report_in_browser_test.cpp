// What Chromium shows of real pages; skipped where it is not installed.
#include <boost/test/unit_test.hpp>

#include "tests/tools/browser.h"
#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tools/report/html_elements.h"
#include "tools/run_page/report_page.h"
#include "tools/stability/stability_report.h"

using namespace misfit::tools;
using namespace misfit::tools::testing;

namespace {

void check_faultless(const std::string& page) {
  for (const std::string& fault : faults_in_browser(page)) BOOST_ERROR(fault);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(report_in_browser, *boost::unit_test::precondition(browser_is_installed))

BOOST_AUTO_TEST_CASE(every_kind_of_fault_is_found) {
  const std::string content = R"html(
    <img alt="broken" src="data:image/png;base64,Zm9v">
    <img alt="far away" src="http://example.org/picture.png">
    <svg style="width: 0" aria-label="none"></svg>
    <p>noise nan Jy</p>
    <div style="width: 1300px">wide</div>
    <div style="overflow: hidden; width: 5rem"><div style="width: 6rem">hidden</div></div>
    <script>console.log("said so"); throw new Error("thrown");</script>)html";
  const std::vector<std::string> faults = faults_in_browser(html::page("Test", content));
  for (const char* fault :
       {"360 px: missing picture: <img> broken", "1280 px: asks for http://example.org/picture.png", "360 px: empty drawing",
        "1280 px: no number: noise nan Jy", "360 px: wider than the page", "1280 px: too wide: <div> wide",
        "360 px: cut off: <div> hidden", "1280 px: scripts: 1", "360 px: error: Uncaught Error: thrown", "said so"})
    BOOST_TEST(std::any_of(faults.begin(), faults.end(), [&](const std::string& found) { return contains(found, fault); }),
               fault);
}

BOOST_AUTO_TEST_CASE(a_page_without_faults_has_none) {
  check_faultless(html::page("Test", "<p>Nantes, infinite, nullify: words.</p>"));
}

BOOST_AUTO_TEST_CASE(the_page_of_a_dirty_image) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "a"));
  check_faultless(content(folder / "a.report.html"));
}

BOOST_AUTO_TEST_CASE(the_page_of_a_clean_run) {
  const TemporaryFolder folder;
  succeed({"image", "--vis", track(), "--imagename", folder / "a", "--imsize", "300", "256", "--cell", "0.05arcsec", "--niter",
           "500", "--usemask", "auto", "--verify", "20"});
  check_faultless(content(folder / "a.report.html"));
}

BOOST_AUTO_TEST_CASE(long_words_and_unknown_numbers_have_room) {
  const std::string word(300, 'x');
  const nlohmann::json report{
      {"version", "0.1.0"},
      {"command_line", "misfit image --vis " + word},
      {"warnings", {word}},
      {"options", {{"imagename", "/folder/" + word}, {"imsize", {16384, 16384}}, {"cell", word}, {"vis", word}}},
      {"plan", {{{"item", word}, {"decision", word}, {"because", word}}}},
      {"error", {{"requested", 1e-6}, {"expected_rms", nullptr}}},
      {"kernel", {{"name", word}}},
      {"visibilities", {{"samples_read", 123456789012}, {"used", 123456789012}}},
      {"beam", {{"major_arcsec", 1234.567}, {"minor_arcsec", 1000.123}, {"pa_deg", -123.456}, {"how", word}, {"misfit", 0.5}}},
      {"timings_s", {{word, 3600}, {"read", 1}, {"total", 4000}}},
      {"timings_expected_s", {{"grid", 2}, {"total", 3000}}}};
  check_faultless(report_page(report, {}));
}

BOOST_AUTO_TEST_CASE(a_page_of_figures_and_tables) {
  const TemporaryFolder folder;
  write_report(
      {.title = "Stability", .introduction = "What rounding does.", .sections = {boundaries_section(), magnitudes_section()}},
      folder / "");
  check_faultless(content(folder / "index.html"));
}

BOOST_AUTO_TEST_SUITE_END()
