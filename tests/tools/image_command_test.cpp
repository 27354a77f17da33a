// From a MeasurementSet to the files of an image.
#include "imager/data/image_statistics.h"
#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"
#include "tools/base/files.h"
#include "tools/formats/sky.h"

BOOST_AUTO_TEST_SUITE(image_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using imager::Image;
using imager::Source;
using nlohmann::json;

constexpr double arcsec = M_PI / 180 / 3600;
constexpr double card_cell_rad = 0.05 * arcsec;

struct Pixel {
  int row = 0;
  int column = 0;
};

Pixel pixel_of(const Source& source, const imager::ImageGeometry& g) {
  return {g.centre_row() + static_cast<int>(std::lround(source.position.m / g.cell_rad)),
          g.centre_column() - static_cast<int>(std::lround(source.position.l / g.cell_rad))};
}

/// How far the summit of the parabola through three values lies from the middle one.
double summit(double before, double middle, double after) {
  return 0.5 * (after - before) / (2 * middle - before - after);
}

/// Sources with no other within `radius_rad`.
std::vector<Source> isolated(const std::vector<Source>& sources, double radius_rad) {
  std::vector<Source> lonely;
  for (const Source& a : sources) {
    int near = 0;
    for (const Source& b : sources) near += std::hypot(a.position.l - b.position.l, a.position.m - b.position.m) < radius_rad;
    if (near == 1) lonely.push_back(a);
  }
  return lonely;
}

Arguments card_image(const std::string& vis, const std::string& imagename) {
  return {"image", "--vis", vis, "--imagename", imagename, "--imsize", "1024", "--cell", "0.05arcsec"};
}

void check_keys(const json& object, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    BOOST_TEST_INFO(key);
    BOOST_TEST(object.contains(key));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(calibrated_data_are_imaged_where_there_are_some_and_files_say_so) {
  const TemporaryFolder folder;
  const std::string set = folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  const auto image = [&](const std::string& name, const Arguments& more) {
    succeed(small_image(set, folder / name) + more);
    const json report = json::parse(content(folder / name + ".report.json"));
    for (const json& decision : report["plan"])
      if (decision["item"] == "data column") return decision["decision"].get<std::string>();
    return std::string();
  };
  BOOST_TEST(image("before", {}) == "DATA");
  std::ofstream(folder / "one.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,3\n";
  succeed({"predict", "--vis", set, "--components", folder / "one.csv", "--column", "CORRECTED_DATA"});
  BOOST_TEST(image("usual", {}) == "CORRECTED_DATA");
  BOOST_TEST(image("corrected", {"--datacolumn", "corrected"}) == "CORRECTED_DATA");
  BOOST_TEST(image("data", {"--datacolumn", "data"}) == "DATA");
  BOOST_TEST((pixels_of(folder / "usual", "residual").pixel == pixels_of(folder / "corrected", "residual").pixel));
  BOOST_TEST((pixels_of(folder / "data", "residual").pixel == pixels_of(folder / "before", "residual").pixel));
  for (const auto& [name, column] : {std::pair("usual", "CORRECTED_DATA"), {"data", "DATA"}})
    BOOST_TEST(content(folder / (std::string(name) + ".residual.fits")).find("HISTORY data column: " + std::string(column)) !=
               std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_column_that_was_never_filled_is_warned_of) {
  const TemporaryFolder folder;
  const std::string set = folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  std::ofstream(folder / "none.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,0\n";
  succeed({"predict", "--vis", set, "--components", folder / "none.csv", "--column", "CORRECTED_DATA"});
  for (const Arguments& mode : {Arguments{}, Arguments{"--specmode", "cube"}}) {
    const Outcome outcome = run(small_image(set, folder / "a") + mode);
    BOOST_TEST(outcome.code == 0);
    BOOST_TEST(outcome.err.find("all that was read of CORRECTED_DATA of " + set + " is 0") != std::string::npos);
    BOOST_TEST(run(small_image(set, folder / "a") + mode + Arguments{"--datacolumn", "data"}).err.find(" is 0") ==
               std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(cleaned_sources_have_their_positions_and_fluxes_in_all_four_quadrants) {
  const TemporaryFolder folder;
  succeed(card_image(track(), folder / "card") + Arguments{"--niter", "20000", "--threshold", "2mJy"});
  const imager::SkyImage sky = imager::read_fits(folder / "card.image.fits");
  BOOST_REQUIRE(sky.has_beam);
  // Beyond three beams a Gaussian is below 1e-10: only isolated sources have peaks of their own.
  const auto sources = isolated(tools::test_card(card_cell_rad), 3 * sky.beam.major_rad);
  std::map<std::pair<bool, bool>, int> quadrant;
  for (const Source& source : sources) {
    const auto [r, c] = pixel_of(source, sky.geometry);
    ++quadrant[{source.position.l > 0, source.position.m > 0}];
    BOOST_TEST_CONTEXT("row " << r << ", column " << c) {
      // Every source lies on a pixel. The residual is at most the threshold, of either sign, anywhere, and model and residual
      // add up to the data: 1 - 2 thresholds are off the peak, and 4 allow for the sidelobes of what the others still lack.
      BOOST_TEST(std::abs(sky.image.at(r, c) - source.flux_jy) < 4 * 2e-3);
      // Near its peak a Gaussian falls by flux·4·ln2·(pixel/FWHM)² within a pixel: at least 2.4% of 1 Jy for a beam of
      // 10.5 pixels. Neighbours that differ by up to 2 thresholds shift the summit by a quarter of 4 mJy / 24 mJy.
      BOOST_TEST(std::abs(summit(sky.image.at(r, c - 1), sky.image.at(r, c), sky.image.at(r, c + 1))) < 0.05);
      BOOST_TEST(std::abs(summit(sky.image.at(r - 1, c), sky.image.at(r, c), sky.image.at(r + 1, c))) < 0.05);
    }
  }
  BOOST_TEST(quadrant.size() == 4U);
  BOOST_TEST(sources.size() >= 20U);
}

BOOST_AUTO_TEST_CASE(the_measured_error_is_below_the_accuracy_asked_and_less_costs_less) {
  const TemporaryFolder folder;
  std::vector<double> cost;
  for (const char* accuracy : {"1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7"}) {
    BOOST_TEST_CONTEXT("accuracy " << accuracy) {
      succeed(card_image(snapshot(), folder / "card") + Arguments{"--accuracy", accuracy, "--verify", "500"});
      const json report = report_of(folder / "card");
      const double asked = std::stod(accuracy);
      BOOST_TEST(report["error"]["requested"].get<double>() == asked);
      BOOST_TEST(report["error"]["measured_rms"].get<double>() <= asked);
      BOOST_TEST(report["error"]["measured_predict_rms"].get<double>() <= asked);
      // The kernel's cells times the FFT's area: what grows with either.
      const json& kernel = report["kernel"];
      cost.push_back(std::pow(kernel["width"].get<double>() * kernel["padding"].get<double>(), 2));
      // The PSF is made to the same accuracy, and its own RMS is below its peak.
      const Image psf = pixels_of(folder / "card", "psf");
      BOOST_TEST(std::abs(psf.at(512, 512) - 1) < std::max(asked, 1e-6));
    }
  }
  for (std::size_t i = 1; i < cost.size(); ++i) BOOST_TEST(cost[i - 1] <= cost[i]);
  BOOST_TEST(cost.front() < cost.back() / 4);
}

BOOST_AUTO_TEST_CASE(the_psf_peaks_at_1_in_images_of_odd_and_unequal_sides) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 64}, {7, 7}, {63, 65}, {128, 31}}) {
    BOOST_TEST_CONTEXT(width << " by " << height) {
      succeed({"image", "--vis", snapshot(), "--imagename", folder / "odd", "--imsize", std::to_string(width),
               std::to_string(height), "--cell", "0.1arcsec", "--quiet"});
      const Image psf = pixels_of(folder / "odd", "psf");
      BOOST_TEST(psf.width == width);
      BOOST_TEST(psf.height == height);
      BOOST_TEST(std::abs(psf.at(height / 2, width / 2) - 1) < 1e-5);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_report_has_every_key_that_others_rely_on) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "10", "--verify", "5"});
  const json report = report_of(folder / "a");
  check_keys(report, {"version", "options", "plan", "kernel", "error", "visibilities", "timings_s", "memory_gib_peak",
                      "memory_gib_estimated", "beam", "clean"});
  check_keys(report["kernel"], {"name", "width", "x0", "padding", "evaluation", "axes"});
  BOOST_TEST(report["kernel"]["axes"].size() == 2U);
  for (const json& axis : report["kernel"]["axes"]) check_keys(axis, {"axis", "width", "x0", "padding"});
  check_keys(report["error"],
             {"requested", "expected_rms", "bound_rms", "bound_max", "measured_rms", "measured_max", "measured_predict_rms"});
  check_keys(report["visibilities"],
             {"rows_read", "samples_read", "used", "flagged", "nonfinite", "zero_weight", "autocorrelations", "outside_grid"});
  check_keys(report["beam"], {"major_arcsec", "minor_arcsec", "pa_deg"});
  check_keys(report["clean"],
             {"iterations", "major_cycles", "stop_code", "stop_reason", "peak_residual_jy", "rms_jy", "model_flux_jy"});
  BOOST_TEST(!report["plan"].empty());
  for (const json& decision : report["plan"]) check_keys(decision, {"item", "decision", "because"});
}

BOOST_AUTO_TEST_CASE(unusable_samples_are_counted_once_under_the_first_reason_that_applies) {
  const TemporaryFolder folder;
  const std::string set = folder / "spoilt.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  const float nan = std::nanf("");
  make_autocorrelation(set, 0);
  flag_row(set, 0);
  flag_row(set, 1);
  flag_sample(set, 2);
  put_data(set, 2, nan);
  put_data(set, 3, nan);
  put_data(set, 4, {0, INFINITY});
  put_weight(set, 5, nan);
  put_u(set, 6, INFINITY);
  put_weight(set, 6, 0);
  put_weight(set, 7, 0);
  put_weight(set, 8, -1);
  put_u(set, 9, 1e6);  // far beyond 1/(2 cell)
  succeed(small_image(set, folder / "a"));
  const json counts = report_of(folder / "a")["visibilities"];
  BOOST_TEST(counts["rows_read"] == 351);
  BOOST_TEST(counts["samples_read"] == 351);
  BOOST_TEST(counts["autocorrelations"] == 1);
  BOOST_TEST(counts["flagged"] == 2);
  BOOST_TEST(counts["nonfinite"] == 4);
  BOOST_TEST(counts["zero_weight"] == 2);
  BOOST_TEST(counts["outside_grid"] == 1);
  BOOST_TEST(counts["used"] == 341);
  for (const double pixel : pixels_of(folder / "a", "residual").pixel) BOOST_REQUIRE(std::isfinite(pixel));
}

BOOST_AUTO_TEST_CASE(data_of_zeros_make_an_image_of_zeros) {
  const TemporaryFolder folder;
  const std::string set = folder / "zero.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  scale_data(set, 0);
  succeed(small_image(set, folder / "a") + Arguments{"--niter", "10", "--verify", "5"});
  for (const char* kind : {"residual", "model", "image"})
    for (const double pixel : pixels_of(folder / "a", kind).pixel) BOOST_REQUIRE_EQUAL(pixel, 0);
}

BOOST_AUTO_TEST_CASE(a_clean_that_gets_nowhere_says_so_and_keeps_a_model_no_worse_than_none) {
  const TemporaryFolder folder;
  // Sources outside so small an image cannot be cleaned away.
  succeed({"image", "--vis", snapshot(), "--imagename", folder / "a", "--imsize", "64", "--cell", "0.2arcsec", "--niter",
           "1000000"});
  const json clean = report_of(folder / "a")["clean"];
  BOOST_TEST((clean["stop_code"] == 4 || clean["stop_code"] == 5 || clean["stop_code"] == 6));  // not the limit
  BOOST_TEST(clean["peak_residual_jy"].get<double>() <= clean["major_cycles_log"][0]["peak_residual_jy"].get<double>());
  for (const char* kind : {"residual", "model", "image"})
    for (const double pixel : pixels_of(folder / "a", kind).pixel) BOOST_REQUIRE(std::isfinite(pixel));
}

BOOST_AUTO_TEST_CASE(the_number_of_threads_changes_no_bit) {
  const TemporaryFolder folder;
  const Arguments clean{"--niter", "100", "--threads"};
  for (const char* threads : {"1", "2", "5"}) succeed(small_image(track(), folder / threads) + clean + Arguments{threads});
  for (const char* kind : {"psf", "residual", "model", "image"}) {
    const Image one = pixels_of(folder / "1", kind);
    BOOST_TEST((one.pixel == pixels_of(folder / "2", kind).pixel));
    BOOST_TEST((one.pixel == pixels_of(folder / "5", kind).pixel));
  }
}

BOOST_AUTO_TEST_CASE(the_options_written_repeat_the_run_bit_for_bit) {
  const TemporaryFolder folder;
  const std::vector<Arguments> runs{{"--niter", "50", "--gain", "0.2", "--threshold", "3mJy", "--spw", "0:0"},
                                    {"--kernel-width", "5", "--padding", "1.5"},
                                    {"--accuracy", "1e-8", "--kernel", "least-misfit"}};
  for (const Arguments& options : runs) {
    const std::string name = folder / "it's \"one\"";
    succeed(Arguments{"image", "--vis", snapshot(), "--imagename", name, "--imsize", "64", "48", "--cell", "0.1arcsec"} +
            options);
    const json report = report_of(name);
    const Image image = pixels_of(name, "residual");
    succeed({"image", "--config", name + ".last.ini"});
    BOOST_TEST(image.height == 48);
    BOOST_TEST((pixels_of(name, "residual").pixel == image.pixel));
    json again = report_of(name)["options"];
    again["quiet"] = report["options"]["quiet"];
    BOOST_TEST(again == report["options"]);
  }
}

BOOST_AUTO_TEST_CASE(options_typed_win_over_those_of_the_file) {
  const TemporaryFolder folder;
  std::ofstream(folder / "run.ini") << "; comment\n# another\n\n vis = " << snapshot()
                                    << "\nimsize=32 16\ncell=\"0.1arcsec\"\n";
  succeed({"image", "--imsize", "20", "--config", folder / "run.ini", "--imagename", folder / "a"});
  BOOST_TEST(pixels_of(folder / "a", "psf").width == 20);
  BOOST_TEST(pixels_of(folder / "a", "psf").height == 20);
}

BOOST_AUTO_TEST_CASE(imaging_changes_nothing_in_the_measurement_set) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  const std::string set = folder / "in/card.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  const auto before = files_below(folder / "in");
  succeed(small_image(set, folder / "a") + Arguments{"--niter", "10", "--verify", "5"});
  BOOST_TEST((files_below(folder / "in") == before));
}

BOOST_AUTO_TEST_CASE(a_dry_run_prints_the_plan_of_the_run_and_its_memory_and_writes_nothing) {
  const TemporaryFolder folder;
  BOOST_REQUIRE_EQUAL(run(small_image(track(), folder / "a") + Arguments{"--check-outside"}).code, 0);
  const json report = report_of(folder / "a");
  const auto before = files_below(folder / "");
  BOOST_TEST(report["timings_expected_s"].contains("sources outside"));
  for (const Arguments& arguments : {small_image(track(), folder / "b"), small_image(track(), folder / "none/b")}) {
    const Outcome outcome = run(arguments + Arguments{"--check-outside", "--dry-run"});
    BOOST_TEST(outcome.out.find("search outside the image: 64 × 64 pixels of 0.4 arcsec; four times") != std::string::npos);
    BOOST_TEST(outcome.code == 0);
    BOOST_TEST(outcome.err == "");
    for (const json& decision : report["plan"]) {
      BOOST_TEST_INFO(decision["item"]);
      const auto part = [&](const char* key) { return decision[key].get<std::string>(); };
      if (part("item") == "samples left out" || part("item") == "sources outside the image") continue;  // known once read
      const bool learned =
          part("item") == "expected time" || part("item") == "search outside the image";  // from the run before
      const std::string line = part("item") + ": " + (learned ? "" : part("decision") + "; " + part("because") + "\n");
      BOOST_TEST(outcome.out.find(line) != std::string::npos);
    }
    for (const auto& [stage, seconds] : report["timings_expected_s"].items())
      if (stage != "total") BOOST_TEST(outcome.out.find("expected: " + stage + " ") != std::string::npos);
    BOOST_TEST(outcome.out.find("memory: 0.") != std::string::npos);
    BOOST_TEST((files_below(folder / "") == before));
  }
}

BOOST_AUTO_TEST_CASE(a_cell_without_a_unit_is_said_to_be_in_arcsec) {
  const TemporaryFolder folder;
  const Arguments bare{"image",    "--vis", snapshot(), "--imagename", folder / "a",
                       "--imsize", "64",    "--cell",   "0.1",         "--dry-run"};
  const Outcome outcome = run(bare);
  BOOST_TEST(outcome.out.find("pixels: 64 × 64 of 100 mas; --cell 0.1 has no unit, and is in arcsec") != std::string::npos);
  BOOST_TEST(outcome.err.find("--cell 0.1 has no unit, and is in arcsec as in tclean\n") != std::string::npos);
  const Outcome told = run(small_image(snapshot(), folder / "b") + Arguments{"--dry-run"});
  BOOST_TEST(told.out.find("pixels: 64 × 64 of 100 mas; --cell 0.1arcsec; ") != std::string::npos);
  BOOST_TEST(told.err == "");
}

BOOST_AUTO_TEST_CASE(a_plan_tells_what_is_in_the_set) {
  const TemporaryFolder folder;
  const std::string plan = run(small_image(track(), folder / "a") + Arguments{"--dry-run"}).out;
  for (const std::string line : {"telescope: EVLA, 27 antennas; observed ", " UTC, 1 h 00 min\n", "\nfields: 0 '",
                                 "; 1 of 1 in the set\n", "\nspectral windows: 0 (", "\nbaselines: ", " km; ",
                                 "; CORRECTED_DATA where a set has it, else DATA; the set has DATA\n"})
    BOOST_TEST(plan.find(line) != std::string::npos, line << " in " << plan);
  const Arguments both{"image",      "--vis",    track(), snapshot(), "--imagename",
                       folder / "a", "--imsize", "64",    "--cell",   "0.1arcsec"};
  const Outcome two = run(both + Arguments{"--dry-run"});
  for (const std::string& set : {track(), snapshot()})
    BOOST_TEST(two.out.find("set " + set + ": EVLA, 27 antennas, observed ") != std::string::npos, two.out);
}

BOOST_AUTO_TEST_CASE(pixels_that_are_too_large_are_answered_with_those_that_are_not) {
  const TemporaryFolder folder;
  const auto image = [&](const std::string& cell) {
    return Arguments{"image", "--vis", snapshot(), "--imagename", folder / "a", "--imsize", "64", "--cell", cell};
  };
  const auto cell_named = [](const std::string& text) {
    const std::size_t end = text.find(" would keep them"), begin = text.rfind(' ', end - 1) + 1;
    return end == std::string::npos ? "" : text.substr(begin, end - begin);
  };
  const Outcome refused = run(image("2deg"));  // beyond 14 λ
  BOOST_TEST(refused.code == 1);
  BOOST_TEST(refused.err.find("expected smaller pixels: a cell of ") != std::string::npos, refused.err);
  const std::string cell = cell_named(refused.err);
  const Outcome some = run(image("5arcsec"));
  BOOST_TEST(cell_named(some.err) == cell);
  const Outcome forecast = run(image("5arcsec") + Arguments{"--dry-run"});
  BOOST_TEST(forecast.err.find("beyond 1/(2 cell) and may be left out; a cell of " + cell) != std::string::npos);
  BOOST_TEST(run(image(cell) + Arguments{"--dry-run"}).err == "");
  BOOST_TEST(run(image(cell)).err.find("beyond") == std::string::npos);
  BOOST_TEST(report_of(folder / "a")["visibilities"]["outside_grid"] == 0);
}

BOOST_AUTO_TEST_CASE(a_dry_run_reads_neither_data_nor_flags) {
  const TemporaryFolder folder;
  const std::string set = folder / "flagged.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  flag_all(set);
  BOOST_TEST(run(small_image(set, folder / "a")).code == 1);
  succeed(small_image(set, folder / "a") + Arguments{"--dry-run"});
}

/// Whether the peak of memory is the program's own: a sanitizer's counts in it.
boost::test_tools::assertion_result memory_is_its_own(boost::unit_test::test_unit_id /*unit*/) {
#ifdef MISFIT_SANITIZED
  return false;
#else
  return true;
#endif
}

BOOST_AUTO_TEST_CASE(the_memory_estimated_is_enough, *boost::unit_test::precondition(memory_is_its_own)) {
  const TemporaryFolder folder;
  for (const Arguments& options :
       {Arguments{},
        {"--niter", "10"},
        {"--verify", "5"},
        {"--check-outside"},
        {"--niter", "10", "--check-outside"},
        {"--accuracy", "1e-3", "--niter", "10"},
        {"--niter", "10", "--deconvolver", "clark"},
        {"--niter", "10", "--deconvolver", "multiscale", "--scales", "0,5,20", "--usemask", "auto"}}) {
    BOOST_REQUIRE_EQUAL(run(card_image(snapshot(), folder / "a") + options).code, 0);
    const json report = report_of(folder / "a");
    const double peak = report["memory_gib_peak"], estimated = report["memory_gib_estimated"];
    BOOST_TEST(peak <= estimated);
    // The program counts for 0.09 GiB, of which a small run takes half; and not every image is made in the moment of most.
    BOOST_TEST(estimated <= 0.1 + 1.5 * peak);
    const std::string memory = std::to_string(report["memory_gib_estimated"].get<double>() + 1e-3);
    BOOST_TEST(run(card_image(snapshot(), folder / "a") + options + Arguments{"--memory", memory}).code == 0);
  }
}

BOOST_AUTO_TEST_CASE(only_the_files_promised_appear) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  succeed(small_image(snapshot(), folder / "out/a") + Arguments{"--niter", "10"});
  for (const char* name : {"psf.fits", "residual.fits", "model.fits", "image.fits", "components.csv", "clean.state",
                           "report.json", "report.html", "last.ini"}) {
    BOOST_TEST_INFO(name);
    BOOST_TEST(std::filesystem::remove(folder / "out/a." + name));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
    BOOST_TEST(entry.path().extension() == ".png");  // pictures, where gnuplot is installed
}

BOOST_AUTO_TEST_CASE(the_page_of_a_clean_shows_five_images_and_their_course_and_where_samples_lie) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "10"});
  const std::string page = content(folder / "a.report.html");
  for (const char* title : {"Restored image", "Residual", "Dirty image", "Model", "PSF", "uv coverage"})
    BOOST_TEST(page.find("<img alt=\"" + std::string(title) + "\"") != std::string::npos, title);
  BOOST_TEST(page.find("Progress of CLEAN") != std::string::npos);
  BOOST_TEST(std::filesystem::exists(folder / "a.dirty.png"));
  succeed(small_image(snapshot(), folder / "b"));
  BOOST_TEST(content(folder / "b.report.html").find("Progress of CLEAN") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_restoring_beam_given_is_used_and_stated) {
  const TemporaryFolder folder;
  const Arguments cleaned{"--niter", "20", "--restoringbeam", "6arcsec,4arcsec,120deg"};
  succeed(small_image(snapshot(), folder / "a") + cleaned);
  const imager::SkyImage restored = imager::read_fits(folder / "a.image.fits");
  BOOST_TEST(restored.beam.major_rad == 6 * arcsec, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(restored.beam.minor_rad == 4 * arcsec, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(restored.beam.position_angle_rad == -M_PI / 3, boost::test_tools::tolerance(1e-6));
  Image should = imager::convolve_with_beam(pixels_of(folder / "a", "model"), restored.beam, restored.geometry.cell_rad, 2);
  const Image residual = pixels_of(folder / "a", "residual");
  for (std::size_t i = 0; i < should.pixel.size(); ++i)  // 32-bit files
    BOOST_REQUIRE(std::abs(should.pixel[i] + residual.pixel[i] - restored.image.pixel[i]) < 1e-5);
  succeed(small_image(snapshot(), folder / "b") + Arguments{"--niter", "20"});
  BOOST_TEST((pixels_of(folder / "b", "residual").pixel == residual.pixel));  // the beam steers no cycle
}

BOOST_AUTO_TEST_CASE(a_run_that_was_cut_goes_on_to_the_same_images) {
  const TemporaryFolder folder;
  const Arguments options{"--niter", "300", "--cycleniter", "40", "--deconvolver", "multiscale", "--scales", "0,4"};
  succeed(small_image(snapshot(), folder / "whole") + options);
  succeed(small_image(snapshot(), folder / "cut") + options + Arguments{"--nmajor", "2"});
  succeed(small_image(snapshot(), folder / "cut") + options + Arguments{"--restart"});
  for (const char* kind : {"model", "residual", "image"})
    BOOST_TEST((pixels_of(folder / "cut", kind).pixel == pixels_of(folder / "whole", kind).pixel));
  json cut = report_of(folder / "cut")["clean"], whole = report_of(folder / "whole")["clean"];
  BOOST_TEST(cut.dump() == whole.dump());

  const auto refused = [&](const Arguments& arguments) {
    const Outcome outcome = run(small_image(snapshot(), folder / "cut") + options + Arguments{"--restart"} + arguments);
    BOOST_TEST(outcome.code == 1);
    return outcome.err;
  };
  BOOST_TEST(refused({"--accuracy", "1e-5"}).find("--accuracy") != std::string::npos);
  const Outcome anew = run(small_image(snapshot(), folder / "new") + options + Arguments{"--restart"});
  BOOST_TEST(anew.code == 0);
  BOOST_TEST(anew.err.find("new.clean.state") != std::string::npos);
}

/// As people do who look at the residual, draw another mask, and go on.
BOOST_AUTO_TEST_CASE(clean_goes_on_with_another_mask_depth_and_deconvolver) {
  const TemporaryFolder folder;
  const auto cleaned = [&](const Arguments& options) {
    const Outcome outcome = run(small_image(snapshot(), folder / "a") + options);
    BOOST_TEST_INFO(outcome.err);
    BOOST_REQUIRE(outcome.code == 0);
    return outcome.err;
  };
  const std::string left = "box[[0pix,0pix],[31pix,63pix]]", right = "box[[32pix,0pix],[63pix,63pix]]";
  cleaned({"--niter", "40", "--mask", left, "--nmajor", "1"});
  const json first = report_of(folder / "a")["clean"];
  const imager::Image of_left = pixels_of(folder / "a", "model");
  const std::string said = cleaned({"--niter", "200", "--mask", right, "--gain", "0.2", "--cyclefactor", "2", "--deconvolver",
                                    "multiscale", "--scales", "0,5", "--restart"});
  BOOST_TEST(contains(said,
                      "warning: CLEAN goes on from its model with another --cyclefactor, --deconvolver, --gain, --mask, "
                      "--scales\n"));
  const json second = report_of(folder / "a")["clean"];
  BOOST_TEST(second["major_cycles_log"][0]["iterations"] == first["iterations"]);
  BOOST_TEST(second["major_cycles_log"][0]["model_flux_jy"] == first["model_flux_jy"]);
  BOOST_TEST(second["iterations"].get<int>() > first["iterations"].get<int>());
  // Components of the first run stay on the left. Those of the second lie on the right; their Gaussians reach over by 5 pixels.
  const imager::Image both = pixels_of(folder / "a", "model");
  double added = 0;
  for (int row = 0; row < both.height; ++row)
    for (int column = 0; column < both.width; ++column)
      if (column < 27)
        BOOST_REQUIRE(both.at(row, column) == of_left.at(row, column));
      else
        added += both.at(row, column) - of_left.at(row, column);
  BOOST_TEST(added != 0);
  // A model of another scale cannot go on as points.
  const Outcome points = run(small_image(snapshot(), folder / "a") + Arguments{"--niter", "200", "--restart"});
  BOOST_TEST(points.code == 1);
  BOOST_TEST(contains(points.err, "a.clean.state has components of scale 5: expected this scale among --scales"));
}

BOOST_AUTO_TEST_CASE(a_start_model_is_where_an_earlier_run_ended) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "50", "--nmajor", "1"});
  succeed(small_image(snapshot(), folder / "b") + Arguments{"--niter", "50", "--startmodel", folder / "a.model.fits"});
  const json before = report_of(folder / "a")["clean"], after = report_of(folder / "b")["clean"]["major_cycles_log"][0];
  // The model passed through a file of 32-bit numbers.
  for (const char* key : {"peak_residual_jy", "model_flux_jy"})
    BOOST_TEST(std::abs(after[key].get<double>() / before[key].get<double>() - 1) < 1e-5);
  BOOST_TEST(report_of(folder / "b")["clean"]["peak_residual_jy"] < before["peak_residual_jy"]);
  // Without more components: the same residual, restored.
  succeed(small_image(snapshot(), folder / "c") + Arguments{"--niter", "0", "--startmodel", folder / "a.model.fits"});
  BOOST_TEST(report_of(folder / "c")["clean"]["iterations"] == 0);
  for (const char* kind : {"model", "residual", "image"}) {
    const imager::Image first = pixels_of(folder / "a", kind), again = pixels_of(folder / "c", kind);
    for (std::size_t i = 0; i < first.pixel.size(); ++i)
      BOOST_REQUIRE(std::abs(again.pixel[i] - first.pixel[i]) < 1e-5 * imager::largest_magnitude(first));
  }
}

BOOST_AUTO_TEST_CASE(a_start_model_of_other_pixels_or_units_is_refused) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "5"});
  const auto refused = [&](const Arguments& arguments) {
    const Outcome outcome = run(small_image(snapshot(), folder / "b") + Arguments{"--niter", "5"} + arguments);
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST(!std::filesystem::exists(folder / "b.report.json"));
    return outcome.err;
  };
  BOOST_TEST(refused({"--startmodel", folder / "a.image.fits"}).find("expected Jy/pixel") != std::string::npos);
  BOOST_TEST(refused({"--startmodel", folder / "none.fits"}).find("none.fits") != std::string::npos);
  Arguments larger = small_image(snapshot(), folder / "b") + Arguments{"--niter", "5", "--startmodel", folder / "a.model.fits"};
  *std::find(larger.begin(), larger.end(), "64") = "66";
  BOOST_TEST(run(larger).err.find("has 64 × 64 pixels, expected 66 × 66 pixels") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_model_column_holds_what_the_model_image_predicts) {
  const TemporaryFolder folder;
  const std::string set = folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  succeed(small_image(set, folder / "a") + Arguments{"--niter", "50", "--savemodel", "modelcolumn"});
  succeed({"predict", "--vis", set, "--model", folder / "a.model.fits", "--column", "PREDICTED"});
  const auto saved = visibilities(set, "MODEL_DATA"), should = visibilities(set, "PREDICTED");
  BOOST_REQUIRE(saved.size() == should.size());
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < saved.size(); ++i) {
    error += std::norm(saved[i] - should[i]);
    norm += std::norm(should[i]);
  }
  BOOST_TEST(norm > 0);
  BOOST_TEST(error <= 1e-14 * norm);  // 32-bit numbers
  succeed(small_image(set, folder / "a") +
          Arguments{"--niter", "5", "--savemodel", "modelcolumn", "--kernel-width", "7", "--padding", "1.5"});
}

BOOST_AUTO_TEST_CASE(a_model_saved_for_some_rows_tells_of_the_others) {
  const TemporaryFolder folder;
  const std::string set = folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  const Arguments save = small_image(set, folder / "a") + Arguments{"--niter", "5", "--savemodel", "modelcolumn"};
  for (const std::string holds : {"MODEL_DATA is 0 there", "MODEL_DATA keeps there what it held before"}) {
    const Outcome outcome = run(save + Arguments{"--antenna", "!0"});  // 26 of 27 · 26 / 2 baselines
    BOOST_TEST(outcome.out.find("model of 325 visibilities in 325 of 351 rows written to MODEL_DATA") != std::string::npos);
    const std::string sentence = "26 of 351 rows of " + set + " are not selected: " + holds;
    BOOST_TEST(outcome.err.find("warning: " + sentence) != std::string::npos, outcome.err);
    const json warnings = report_of(folder / "a")["warnings"];
    BOOST_TEST(std::count(warnings.begin(), warnings.end(), sentence) == 1);
  }
  BOOST_TEST(run(save).err.find("not selected") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_neglected_w_is_told_of_where_its_phase_exceeds_the_accuracy) {
  const TemporaryFolder folder;
  succeed({"simulate", "--output", folder / "w.ms", "--noncoplanar"});
  const Arguments plan = small_image(folder / "w.ms", folder / "a") + Arguments{"--gridder", "standard", "--dry-run"};
  const auto told = [](const Outcome& outcome) {
    return outcome.err.find("of that size; --gridder wide takes w exactly") != std::string::npos;
  };
  BOOST_TEST(told(run(plan)));  // 7e-5 rad
  BOOST_TEST(!told(run(plan + Arguments{"--accuracy", "1e-2"})));
}

BOOST_AUTO_TEST_CASE(the_mask_given_is_written_and_holds_all_components) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mask.crtf") << "circle [[32pix, 32pix], 6pix]\n";
  const Arguments cleaned{"--niter", "50", "--mask"};
  succeed(small_image(snapshot(), folder / "a") + cleaned + Arguments{folder / "mask.crtf"});
  const Image mask = pixels_of(folder / "a", "mask"), model = pixels_of(folder / "a", "model");
  BOOST_TEST(std::count(mask.pixel.begin(), mask.pixel.end(), 1.0) == 113);  // pixels within 6 of a pixel
  for (std::size_t i = 0; i < mask.pixel.size(); ++i) BOOST_REQUIRE((mask.pixel[i] != 0 || model.pixel[i] == 0));
  succeed(small_image(snapshot(), folder / "b") + cleaned + Arguments{folder / "a.mask.fits"});
  BOOST_TEST((pixels_of(folder / "b", "model").pixel == model.pixel));
}

BOOST_AUTO_TEST_CASE(files_of_the_user_under_names_of_products_stay) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.mask.fits") << "mine";
  succeed(small_image(snapshot(), folder / "a"));
  BOOST_TEST(misfit::tools::read_file(folder / "a.mask.fits") == "mine");
  std::ofstream(folder / "mask.crtf") << "circle [[32pix, 32pix], 6pix]\n";
  succeed(small_image(snapshot(), folder / "b") + Arguments{"--niter", "5", "--mask", folder / "mask.crtf"});
  std::string kept = misfit::tools::read_file(folder / "b.mask.fits");
  kept.replace(kept.find("ORIGIN  = 'misfit"), 17, "ORIGIN  = 'others");
  std::ofstream(folder / "a.mask.fits", std::ios::binary) << kept;
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "5", "--mask", folder / "a.mask.fits"});
  succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "5"});
  BOOST_TEST(misfit::tools::read_file(folder / "a.mask.fits") == kept);
  succeed(small_image(snapshot(), folder / "b"));
  BOOST_TEST(!std::filesystem::exists(folder / "b.mask.fits"));  // which an earlier run made
}

BOOST_AUTO_TEST_CASE(a_mask_outside_the_image_cleans_nothing_and_says_so) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mask.crtf") << "box [[100pix, 100pix], [120pix, 120pix]]\n";
  const Outcome outcome =
      run(small_image(snapshot(), folder / "a") + Arguments{"--niter", "50", "--mask", folder / "mask.crtf"});
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(outcome.err.find("allows no pixel") != std::string::npos);
  BOOST_TEST(report_of(folder / "a")["clean"]["stop_code"] == 7);
}

BOOST_AUTO_TEST_CASE(region_text_as_a_mask_is_that_of_a_file_and_of_the_next_run) {
  const TemporaryFolder folder;
  const std::string text = "circle [[20pix, 25pix], 3pix], corr=[I], label=\"it's; here\"";
  std::ofstream(folder / "mask.crtf") << text;
  const Arguments options{"--niter", "5", "--mask"};
  succeed(small_image(snapshot(), folder / "a") + options + Arguments{text});
  succeed(small_image(snapshot(), folder / "b") + options + Arguments{folder / "mask.crtf"});
  succeed({"image", "--config", folder / "a.last.ini", "--imagename", folder / "c"});
  const imager::Image mask = imager::read_fits(folder / "b.mask.fits").image;
  BOOST_TEST(std::count(mask.pixel.begin(), mask.pixel.end(), 1.0) == 29);
  for (const char* name : {"a", "c"})
    BOOST_TEST(imager::read_fits(folder / (std::string(name) + ".mask.fits")).image.pixel == mask.pixel);
  BOOST_TEST(report_of(folder / "c")["options"]["mask"] == text);
}

BOOST_AUTO_TEST_CASE(a_name_with_blanks_quotes_and_umlauts_is_a_name) {
  const TemporaryFolder folder;
  const std::string odd = folder / "a 'b' \"c\" ü;$(d)";
  std::filesystem::create_directory(odd);
  std::filesystem::copy(snapshot(), odd + "/s.ms", std::filesystem::copy_options::recursive);
  succeed(small_image(odd + "/s.ms/", odd + "/%d a"));
  BOOST_TEST(pixels_of(odd + "/%d a", "psf").width == 64);
}

BOOST_AUTO_TEST_CASE(names_of_any_bytes_are_imaged_and_a_terminal_obeys_none) {
  const TemporaryFolder folder;
  const std::string set = folder / "b\xe4r.ms", image = folder / "b\xe4r";  // Latin-1
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  name_all(set, "\x1b]0;owned\x07\xff\n<b>");
  const Outcome far = run(small_image(set, image) + Arguments{"--phasecenter", "J2000 12h00m00s -80d00m00s"});
  BOOST_TEST(far.code == 0);
  BOOST_TEST(far.err.find("beyond the first null of the beam: field 0 (?]0;owned??"
                          "?<b>") != std::string::npos);
  BOOST_TEST(far.err.find('\x1b') == std::string::npos);
  const std::string page = content(image + ".report.html");
  BOOST_TEST(page.find('\x1b') == std::string::npos);
  BOOST_TEST(page.find("]0;owned?") != std::string::npos);
  BOOST_TEST(page.find("<b>: they") == std::string::npos);
  BOOST_TEST(report_of(image).dump().find("b\xef\xbf\xbdr.ms") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(samples_without_baselines_are_an_image_of_their_mean) {
  const TemporaryFolder folder;
  const std::string set = folder / "origin.ms";
  succeed({"simulate", "--output", set});
  scale_uvw(set, 0);
  succeed({"image", "--vis", set, "--imagename", folder / "mean", "--imsize", "32", "--cell", "1arcsec"});
  const Image dirty = imager::read_fits(folder / "mean.residual.fits").image;
  const auto [least, most] = std::minmax_element(dirty.pixel.begin(), dirty.pixel.end());
  BOOST_TEST(*most - *least < 1e-4 * std::abs(*most));  // the accuracy asked
  BOOST_TEST(std::filesystem::exists(folder / "mean.uv.png"));
}

BOOST_AUTO_TEST_SUITE_END()
