#include "tools/run/run_report.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <numbers>

BOOST_AUTO_TEST_SUITE(run_report)

using namespace misfit;
using nlohmann::json;

BOOST_AUTO_TEST_CASE(what_does_not_exist_is_null) {
  const json report = tools::report_json({});
  for (const char* part : {"kernel", "beam", "clean", "restored"}) {
    BOOST_TEST_INFO(part);
    BOOST_TEST(report.at(part).is_null());
  }
  for (const auto& [name, value] : report.at("error").items()) {
    BOOST_TEST_INFO(name);
    BOOST_TEST(value.is_null());
  }
}

BOOST_AUTO_TEST_CASE(direct_sums_have_no_kernel) {
  imager::GriddingPlan plan;
  plan.direct = true;
  tools::RunReport run;
  run.gridding = &plan;
  BOOST_TEST(tools::report_json(run).at("kernel").is_null());
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_is_null) {
  tools::RunReport run;
  imager::TheoreticalError& theory = run.channels.front().stokes.front().theory.emplace();
  theory.expected_rms = std::numeric_limits<double>::quiet_NaN();
  theory.bound_rms = std::numeric_limits<double>::infinity();
  theory.bound_max = 0.5;
  const json error = tools::report_json(run).at("error");
  BOOST_TEST(error.at("expected_rms").is_null());
  BOOST_TEST(error.at("bound_rms").is_null());
  BOOST_TEST(error.at("bound_max") == 0.5);
}

BOOST_AUTO_TEST_CASE(beams_are_in_arcseconds_and_degrees) {
  tools::RunReport run;
  const imager::Beam beam{std::numbers::pi / 180 / 3600, std::numbers::pi / 180 / 7200, -std::numbers::pi / 6};
  tools::BeamChoice beams;
  beams.restoring = beam;
  beams.how = "given";
  beams.misfit = 0.25;
  run.channels.front().beams = beams;
  const json json_beam = tools::report_json(run).at("beam");
  // Each is two or three products away.
  BOOST_TEST(std::abs(json_beam.at("major_arcsec").get<double>() - 1) < 1e-15);
  BOOST_TEST(std::abs(json_beam.at("minor_arcsec").get<double>() - 0.5) < 1e-15);
  BOOST_TEST(std::abs(json_beam.at("pa_deg").get<double>() + 30) < 1e-13);
  BOOST_TEST(json_beam.at("how") == "given");
  BOOST_TEST(json_beam.at("misfit") == 0.25);
}

BOOST_AUTO_TEST_CASE(clean_states_the_cycle_that_was_kept) {
  tools::RunReport run;
  imager::CleanReport clean;
  clean.iterations = 30;
  clean.stop = imager::CleanStop::diverging;
  clean.stop_reason = "it grew";
  clean.cycles = {
      {0, 3, 0.3, 0, 0, "", 9, 0}, {10, 1, 0.1, 5, 0.5, "deep enough", 1, 0}, {30, 9, 0.9, 7, 0.2, "", 81, 1e-3, 1}};
  clean.kept = 1;
  run.channels.front().stokes.front().clean = clean;
  const json report = tools::report_json(run).at("clean");
  BOOST_TEST(report.at("iterations") == 30);
  BOOST_TEST(report.at("major_cycles") == 2);
  BOOST_TEST(report.at("stop_code") == 5);
  BOOST_TEST(report.at("stop_reason") == "it grew");
  BOOST_TEST(report.at("peak_residual_jy") == 1);
  BOOST_TEST(report.at("model_flux_jy") == 5);
  BOOST_TEST(report.at("kept_cycle") == 1);
  BOOST_TEST(report.at("major_cycles_log").size() == 3U);
  BOOST_TEST(report.at("major_cycles_log")[1].at("ended") == "deep enough");
}

BOOST_AUTO_TEST_CASE(the_peak_of_the_restored_image_has_a_place_on_the_sky) {
  constexpr double degree = std::numbers::pi / 180;
  tools::RunReport run;
  run.geometry = {64, 32, degree, {30 * degree, 0}};
  imager::CleanReport clean;
  clean.cycles.resize(1);
  tools::StokesReport& of = run.channels.front().stokes.front();
  of.brightest = {.row = 16, .column = 2, .value = -0.5};  // 30 pixels east of the middle, on the equator
  BOOST_TEST(tools::report_json(run).at("restored").is_null());
  of.clean = clean;
  const json restored = tools::report_json(run).at("restored");
  BOOST_TEST(restored.at("peak_jy") == -0.5);
  BOOST_TEST(restored.at("column") == 2);
  BOOST_TEST(restored.at("row") == 16);
  BOOST_TEST(std::abs(restored.at("ra_deg").get<double>() - 30 - std::asin(30 * degree) / degree) < 1e-12);
  BOOST_TEST(std::abs(restored.at("dec_deg").get<double>()) < 1e-12);
  of.brightest.column = 63;
  of.brightest.row = 0;
  run.geometry.cell_rad = 1;
  BOOST_TEST(tools::report_json(run).at("restored").at("ra_deg").is_null());  // beyond the horizon
}

BOOST_AUTO_TEST_CASE(timings_are_the_stages_and_the_total) {
  tools::RunReport run;
  imager::StageTimes times;
  times.add("grid", 1.5);
  times.add("fft", 0.25);
  times.add("grid", 0.5);
  run.times = &times;
  run.wall_clock_s = 3;
  BOOST_TEST((tools::report_json(run).at("timings_s") == json{{"grid", 2.0}, {"fft", 0.25}, {"total", 3.0}}));
}

BOOST_AUTO_TEST_SUITE_END()
