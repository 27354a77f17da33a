#include "tools/run_page/report_page.h"

#include <boost/test/unit_test.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(report_page)

using misfit::tools::testing::balanced;
using misfit::tools::testing::contains;
using nlohmann::json;

namespace {

json full_report() {
  return json::parse(R"({
    "version": "0.1.0", "command_line": "misfit image --vis 'a b.ms'", "warnings": ["w reaches 0.8 rad & more <here>"],
    "options": {"imagename": "out/<m87>", "imsize": [1024, 768], "cell": "0.05arcsec", "niter": 100, "mask": null},
    "plan": [{"item": "kernel", "decision": "W = 7", "because": "4e-7 < 1e-6"}],
    "kernel": {"name": "least-misfit", "width": 7, "x0": 0.25, "padding": 2.0, "evaluation": "polynomial"},
    "error": {"requested": 1e-6, "expected_rms": 4e-7, "bound_rms": null, "bound_max": null, "measured_rms": 2e-6,
              "measured_max": 3e-6, "measured_predict_rms": null},
    "visibilities": {"rows_read": 351, "samples_read": 1404, "used": 1300, "flagged": 100, "nonfinite": 4, "zero_weight": 0,
                     "autocorrelations": 0, "outside_grid": 0},
    "timings_s": {"read": 0.5, "grid": 1.0, "total": 2.0}, "memory_gib_peak": 0.2,
    "residual_histogram": {"noise_jy": 0.002, "min_jy": -0.008, "max_jy": 0.025, "pixels": 1000000, "beyond_5_sigma": 3},
    "beam": {"major_arcsec": 0.4, "minor_arcsec": 0.3, "pa_deg": -12.5},
    "beam_by_quadrant": {"major_arcsec": 0.45, "minor_arcsec": 0.35, "pa_deg": -10},
    "clean": {"iterations": 100, "major_cycles": 2, "stop_code": 1, "stop_reason": "iteration limit", "peak_residual_jy": 0.01,
              "rms_jy": 0.001, "model_flux_jy": 2.5,
              "major_cycles_log": [
                {"iterations": 0, "peak_residual_jy": 1.0, "rms_jy": 0.1, "model_flux_jy": 0, "cycle_threshold_jy": 0},
                {"iterations": 50, "peak_residual_jy": 0.1, "rms_jy": 0.01, "model_flux_jy": 2, "cycle_threshold_jy": 0.12},
                {"iterations": 100, "peak_residual_jy": 0.01, "rms_jy": 0.001, "model_flux_jy": 2.5, "cycle_threshold_jy": 0.02}]}
  })");
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_element_is_closed_whatever_is_missing) {
  BOOST_TEST(balanced(misfit::tools::report_page(full_report(), {{"Image", "bytes"}})));
  BOOST_TEST(balanced(misfit::tools::report_page(json::object(), {})));
  const json complete = full_report();
  for (const auto& [key, value] : complete.items()) {
    json report = complete;
    report[key] = nullptr;
    BOOST_TEST(balanced(misfit::tools::report_page(report, {})), key);
    for (const auto& [inner, ignored] : value.items()) {
      if (!value.is_object()) break;
      json partial = complete;
      partial[key][inner] = nullptr;
      BOOST_TEST(balanced(misfit::tools::report_page(partial, {})), key + "." + inner);
    }
  }
}

BOOST_AUTO_TEST_CASE(text_is_escaped) {
  const std::string page = misfit::tools::report_page(full_report(), {{"\"Image\" <1>", "bytes"}});
  BOOST_TEST(contains(page, "out/&lt;m87&gt;"));
  BOOST_TEST(contains(page, "0.8 rad &amp; more &lt;here&gt;"));
  BOOST_TEST(contains(page, "alt=\"&quot;Image&quot; &lt;1&gt;\""));
  BOOST_TEST(contains(page, "misfit image --vis &#39;a b.ms&#39;"));
}

BOOST_AUTO_TEST_CASE(the_size_of_the_image_is_told_however_it_was_given) {
  json report = full_report();
  for (const auto& [given, told] : {std::pair{json({1024, 768}), "1024 × 768"},
                                    {json("1024 768"), "1024 × 768"},
                                    {json("512"), "512 × 512"},
                                    {json(512), "512 × 512"}}) {
    report["options"]["imsize"] = given;
    BOOST_TEST(contains(misfit::tools::report_page(report, {}), told + std::string(" pixels")), given.dump());
  }
}

BOOST_AUTO_TEST_CASE(the_page_needs_nothing_from_elsewhere) {
  const std::string page = misfit::tools::report_page(full_report(), {{"Image", "foo"}});
  BOOST_TEST(contains(page, "src=\"data:image/png;base64,Zm9v\""));
  for (const char* outside : {"http", "<script", "<link", "@import", "url("}) BOOST_TEST(!contains(page, outside), outside);
}

BOOST_AUTO_TEST_CASE(options_that_were_not_given_are_left_out) {
  json report = full_report();
  report["options"]["spw"] = "";
  report["options"]["scales"] = "[]";
  const std::string page = misfit::tools::report_page(report, {});
  BOOST_TEST(contains(page, "<code>--niter</code>"));
  for (const char* option : {"--mask", "--spw", "--scales"}) BOOST_TEST(!contains(page, option), option);
}

BOOST_AUTO_TEST_CASE(what_was_not_measured_is_said_so) {
  json report = full_report();
  report["error"]["measured_rms"] = std::numeric_limits<double>::quiet_NaN();
  const std::string page = misfit::tools::report_page(report, {});
  BOOST_TEST(contains(page, "not measured"));
  BOOST_TEST(!contains(page, "NaN"));
  BOOST_TEST(!contains(page, "nan"));
  BOOST_TEST(!contains(page, "null"));
}

BOOST_AUTO_TEST_CASE(an_error_beyond_what_was_asked_stands_out) {
  json report = full_report();
  BOOST_TEST(contains(misfit::tools::report_page(report, {}), "✗ exceeds 10<sup>−6</sup> asked for"));
  report["error"]["measured_rms"] = nullptr;
  BOOST_TEST(contains(misfit::tools::report_page(report, {}), "✓ within 10<sup>−6</sup> asked for"));
}

BOOST_AUTO_TEST_CASE(the_error_of_the_transform_is_told_from_that_of_the_image) {
  BOOST_TEST(contains(misfit::tools::report_page(full_report(), {}), "it says nothing of CLEAN, calibration or noise"));
}

BOOST_AUTO_TEST_CASE(the_peak_of_the_restored_image_is_told_with_its_place) {
  json report = full_report();
  BOOST_TEST(!contains(misfit::tools::report_page(report, {}), "Restored"));
  report["restored"] = {{"peak_jy", 0.25}, {"ra_deg", 187.5}, {"dec_deg", -12.5}, {"column", 500}, {"row", 300}};
  const std::string page = misfit::tools::report_page(report, {});
  for (const char* text : {"250 mJy/beam", "peak, at 12h 30m 00.000s", "−12° 30′ 00.00″", "pixel 500, 300"})
    BOOST_TEST(contains(page, text), text);
  report["restored"]["ra_deg"] = nullptr;  // beyond the horizon
  BOOST_TEST(contains(misfit::tools::report_page(report, {}), "<small>peak</small>"));
}

BOOST_AUTO_TEST_CASE(a_histogram_is_shown_with_its_numbers) {
  const std::string drawing = "<svg class=\"here\"></svg>";
  const std::string page = misfit::tools::report_page(full_report(), {}, {.histogram = drawing, .spectrum = ""});
  for (const char* text : {drawing.c_str(), "Noise σ = 2 mJy/beam", "from −4\u00a0σ to 12.5\u00a0σ",
                           "3 of 1\u2009000\u2009000 lie beyond 5\u00a0σ", "noise alone would leave 0.6"})
    BOOST_TEST(contains(page, text), text);
  BOOST_TEST(!contains(misfit::tools::report_page(full_report(), {}), "lie beyond"));
}

BOOST_AUTO_TEST_CASE(expected_times_are_shown_where_they_are_known) {
  json report = full_report();
  BOOST_TEST(!contains(misfit::tools::report_page(report, {}), "Expected"));
  report["timings_expected_s"] = {{"grid", 0.9}, {"total", 1.8}};
  BOOST_TEST(contains(misfit::tools::report_page(report, {}), "900 ms"));
}

BOOST_AUTO_TEST_SUITE_END()
