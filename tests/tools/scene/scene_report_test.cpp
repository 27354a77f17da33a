// misfit report scene: measured, and said of what was measured.
#include "tools/scene/scene_report.h"

#include <cerrno>
#include <functional>
#include <iterator>
#include <random>
#include <sstream>

#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"
#include "tools/scene/results_file.h"
#include "tools/scene/scene_memory.h"
#include "tools/scene/timing.h"
#include "tools/scene/verdict.h"

BOOST_AUTO_TEST_SUITE(scene_report)

namespace {

using namespace misfit;
using namespace misfit::tools;
using namespace misfit::tools::testing;

/// In 10000 seconds no point is left out on a slow machine.
Arguments report_of_scene(const std::string& output, const std::string& seconds = "10000") {
  return {"report", "scene",     "--vis",   snapshot(),  "--imsize", "64",       "48",
          "--cell", "0.1arcsec", "--quick", "--seconds", seconds,    "--output", output};
}

/// Two rounds of some points.
Arguments short_report_of_scene(const std::string& output) {
  return report_of_scene(output, "0.1");
}

/// Cells of a CSV file without quoted commas, by column.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& path) {
  std::istringstream lines(content(path));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream rest(line);
    for (std::string cell; std::getline(rest, cell, ',');) found.push_back(cell);
    return found;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = cells(line);
    for (std::size_t i = 0; i < row.size(); ++i) (i == 0 ? rows.emplace_back() : rows.back())[columns[i]] = row[i];
  }
  return rows;
}

PointResult point(const std::string& kernel, double seconds, double error) {
  PointResult result;
  result.point.kernel = kernel;
  result.work = kernel + std::to_string(seconds);
  result.errors.rms = error;
  result.runs = {{.grid = seconds}};
  return result;
}

/// A program of that name before all others on PATH, while this lives: a shell script.
class Impostor {
 public:
  Impostor(const std::string& name, const std::string& script) {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }

 private:
  TemporaryFolder folder_;
  EnvironmentVariable path_{"PATH", folder_ / "" + ":" + std::getenv("PATH")};
};

/// The results that a report which was stopped has kept.
std::string kept_in(const std::string& output) {
  return output + "/measured.json";
}

/// Runs a report until it keeps other results than `before`, and stops it; what it said.
std::string stopped_report_of(const std::string& vis, const std::string& output, const std::string& before) {
  Arguments arguments = report_of_scene(output);
  arguments[3] = vis;
  Child child(arguments);
  while (!child.ended() && content(kept_in(output)) == before) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  child.signal(SIGINT);
  const Outcome outcome = child.wait();
  BOOST_TEST(outcome.code == 130, outcome.err);
  return outcome.err;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_point_is_measured_within_its_bounds_and_its_command_makes_it, *boost::unit_test::label("sweep")) {
  const TemporaryFolder folder;
  succeed(report_of_scene(folder / "report"));
  BOOST_TEST(!std::filesystem::exists(folder / "report/measured.json"));
  const auto rows = rows_of(folder / "report/scene.csv");
  BOOST_REQUIRE(rows.size() > 50);
  std::size_t on_front = 0;
  const std::map<std::string, std::string>* exact = nullptr;
  for (const auto& row : rows) {
    BOOST_TEST_CONTEXT(row.at("command")) {
      for (const char* column : {"kernel", "width", "x0", "evaluation", "precision", "time_s", "measured_rms", "measured_max",
                                 "bound_rms", "bound_max", "expected_rms", "predict_rms", "pareto"})
        BOOST_TEST(!row.at(column).empty());
      BOOST_TEST(std::stod(row.at("measured_rms")) <= std::stod(row.at("bound_rms")));
      BOOST_TEST(std::stod(row.at("measured_max")) <= std::stod(row.at("bound_max")));
      BOOST_TEST(std::stod(row.at("time_s")) > 0);
      BOOST_TEST(std::stod(row.at("x0")) >=
                 0.5 / std::stod(row.at("padding")) - 1e-6);  // even image: the kernel reaches its edge
    }
    on_front += row.at("pareto") == "yes" ? 1 : 0;
    if (row.at("evaluation").find("linear") != std::string::npos) exact = &row;
  }
  BOOST_TEST(on_front >= 1U);  // of few samples direct sums may be the fastest and the most exact
  BOOST_TEST(on_front < rows.size());
  const std::string page = content(folder / "report/index.html");
  BOOST_TEST(page.find("Samples left out: 0 of 351 (all can be imaged).") != std::string::npos);
  BOOST_TEST(page.find("for the choice of pixels (one standard error") != std::string::npos);
  BOOST_REQUIRE(exact != nullptr);
  std::istringstream words(exact->at("command"));
  Arguments command;
  for (std::string word; words >> word;) command.push_back(word);
  BOOST_REQUIRE(command.front() == "misfit");
  command.erase(command.begin());
  std::replace(command.begin(), command.end(), std::string("image"), folder / "again");
  command.front() = "image";
  succeed(command + Arguments{"--verify", "3000"});
  const nlohmann::json report = report_of(folder / "again");
  BOOST_TEST(report["kernel"]["evaluation"] == exact->at("evaluation"));
  BOOST_TEST(std::to_string(report["kernel"]["width"].get<int>()) == exact->at("width"));
  // Other pixels of the same image.
  BOOST_TEST(report["error"]["measured_rms"].get<double>() == std::stod(exact->at("measured_rms")),
             boost::test_tools::tolerance(0.25));
}

BOOST_AUTO_TEST_CASE(kernels_of_libraries_are_compared_and_commands_name_their_folder) {
  const TemporaryFolder folder;
  succeed(short_report_of_scene(folder / "report") +
          Arguments{"--kernel", "gauss", "gauss-wide", "--kernel-folder", MISFIT_PLUGINS});
  for (const auto& row : rows_of(folder / "report/scene.csv"))
    BOOST_TEST(row.at("command").find(" --kernel-folder " MISFIT_PLUGINS) != std::string::npos);
  const std::string page = content(folder / "report/index.html");
  for (const char* kernel : {"gauss", "gauss-wide"})
    BOOST_TEST(page.find("--kernel " + std::string(kernel) + " ") != std::string::npos);
}

/// Whatever is wrong with a set.
BOOST_AUTO_TEST_CASE(what_an_image_is_warned_of_a_report_is_too_and_what_is_refused_it_refuses) {
  const std::map<std::string, std::function<void(const std::string&)>> spoil{
      {"fields apart",
       [](const std::string& set) {
         add_field(set, {"ASIDE", M_PI / 3, 2 * M_PI / 9 + 5e-4});
       }},
      {"zeros in a field",
       [](const std::string& set) {
         scale_data(set, 0);
         add_field(set, {"AGAIN", M_PI / 3, 2 * M_PI / 9});
         for (const std::size_t row : {0U, 2U, 4U}) put_data(set, row, 1);
       }},
      {"feeds apart", [](const std::string& set) { add_feed(set, 5e-4, 0); }},
      {"fields far apart", [](const std::string& set) {
         add_field(set, {"ASIDE", M_PI / 3, 2 * M_PI / 9 + 0.1});
       }}};
  for (const auto& [what, change] : spoil) {
    const TemporaryFolder folder;
    const std::string set = folder / "copy.ms", direction = "J2000 4h00m00s +40d00m00s";
    std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
    change(set);
    const Outcome image = run({"image", "--vis", set, "--imagename", folder / "a", "--imsize", "64", "48", "--cell",
                               "0.1arcsec", "--phasecenter", direction, "--gridder", "standard"});
    Arguments arguments = short_report_of_scene(folder / "report");
    *std::find(arguments.begin(), arguments.end(), snapshot()) = set;
    const Outcome report = run(arguments + Arguments{"--phasecenter", direction, "--gridder", "standard"});
    BOOST_TEST_CONTEXT(what << ": " << image.err << report.err) {
      BOOST_TEST(report.code == image.code);
      BOOST_TEST(image.code == (what == "fields far apart" ? 1 : 0));
      if (image.code != 0) {
        BOOST_TEST(report.err == image.err);
        continue;
      }
      const auto warnings = report_of(folder / "a")["warnings"];
      BOOST_TEST(!warnings.empty());
      const std::string page = content(folder / "report/report.json");
      for (const std::string warning : warnings) {
        BOOST_TEST(report.err.find("warning: " + warning) != std::string::npos, warning);
        BOOST_TEST(nlohmann::json::parse(page).dump().find(nlohmann::json(warning).dump().substr(1, 40)) != std::string::npos);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(data_of_zeros_alone_are_refused_since_images_of_them_have_no_error) {
  const TemporaryFolder folder;
  std::filesystem::copy(snapshot(), folder / "copy.ms", std::filesystem::copy_options::recursive);
  scale_data(folder / "copy.ms", 0);
  Arguments arguments = short_report_of_scene(folder / "report");
  *std::find(arguments.begin(), arguments.end(), snapshot()) = folder / "copy.ms";
  const Outcome report = run(arguments);
  BOOST_TEST(report.code == 1);
  BOOST_TEST(report.err.find(folder / "copy.ms" + ": all visibilities of DATA that can be used are 0") != std::string::npos,
             report.err);
}

BOOST_AUTO_TEST_CASE(a_report_that_was_stopped_goes_on_from_what_it_had) {
  const TemporaryFolder folder;
  Child child(report_of_scene(folder / "report"));
  const std::string kept = folder / "report/measured.json";
  while (!child.ended() && !std::filesystem::exists(kept)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  child.signal(SIGINT);
  BOOST_REQUIRE_EQUAL(child.wait().code, 130);
  BOOST_REQUIRE(std::filesystem::exists(kept));
  BOOST_TEST(!std::filesystem::exists(folder / "report/index.html"));
  const Outcome again = run(short_report_of_scene(folder / "report"));
  BOOST_TEST(again.code == 0);
  BOOST_TEST(again.err.find("going on from") != std::string::npos);
  BOOST_TEST(std::filesystem::exists(folder / "report/index.html"));
}

BOOST_AUTO_TEST_CASE(a_program_that_fails_is_said_and_the_rest_of_the_report_stays) {
  const TemporaryFolder folder;
  succeed({"image", "--vis", snapshot(), "--imagename", folder / "made", "--imsize", "64", "48", "--cell", "0.1arcsec"});
  const Impostor wsclean("wsclean", "case \"$*\" in\n*-predict*) ;;\n*'-grid-mode nn'*) exec cp " +
                                        folder / "made.residual.fits" +
                                        " wsclean-dirty.fits ;;\nesac\necho 'no such set today'\nexit 1\n");
  succeed(short_report_of_scene(folder / "report"));
  BOOST_TEST(rows_of(folder / "report/scene.csv").size() >= 10);
  std::istringstream programs(content(folder / "report/programs.csv"));
  int failed = 0, made = 0;  // one fails as it predicts
  for (std::string line; std::getline(programs, line);) {
    const bool without_numbers = line.find(": failed, no such set today\",,,,,,,") != std::string::npos;
    failed += line.find("wsclean") != std::string::npos && without_numbers ? 1 : 0;
    made += line.find("misfit image, to") != std::string::npos && line.find("failed") == std::string::npos ? 1 : 0;
  }
  BOOST_TEST(failed == 4);
  BOOST_TEST(made == 2);
  BOOST_TEST(content(folder / "report/index.html").find("failed, no such set today") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_interrupt_during_whole_programs_stops_them_and_keeps_what_was_measured) {
  const TemporaryFolder folder;
  const std::string started = folder / "started", work = folder / "work";
  std::filesystem::create_directory(work);
  const Impostor wsclean("wsclean", "[ \"$1\" = --version ] && exit\necho $$ > " + started + ".part\nmv " + started + ".part " +
                                        started + "\nexec sleep 1000\n");
  const Arguments arguments = short_report_of_scene(folder / "report");  // makes folders that outlive this test
  const EnvironmentVariable temporary("TMPDIR", work);
  Child child(arguments);
  while (!child.ended() && !std::filesystem::exists(started)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  child.signal(SIGINT);
  const Outcome outcome = child.wait();
  BOOST_TEST(outcome.code == 130);
  BOOST_TEST(outcome.err.ends_with("misfit: stopped by the user\n"), outcome.err);
  BOOST_TEST(std::filesystem::exists(kept_in(folder / "report")));
  BOOST_TEST(!std::filesystem::exists(folder / "report/index.html"));
  const std::filesystem::directory_iterator left(work);
  BOOST_TEST(std::distance(begin(left), end(left)) == 1);  // what the child said
  const int program = std::stoi(content(started));
  BOOST_TEST((kill(program, 0) == -1 && errno == ESRCH));
}

BOOST_AUTO_TEST_CASE(results_of_other_data_of_the_same_shape_are_not_used) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", output = folder / "report";
  const auto renew = [&] {
    std::filesystem::remove_all(set);
    std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  };
  const std::string going_on = "going on from";
  renew();
  BOOST_TEST(stopped_report_of(set, output, "").find(going_on) == std::string::npos);
  const std::string kept = content(kept_in(output));
  renew();
  BOOST_TEST(stopped_report_of(set, output, kept).find(going_on) != std::string::npos);  // the same data
  const std::pair<const char*, std::function<void()>> changes[] = {{"all weights", [&] { put_weights(set, 0.25F); }},
                                                                   {"a weight", [&] { put_weight(set, 7, 3); }},
                                                                   {"a flag", [&] { flag_row(set, 7); }},
                                                                   {"a value",
                                                                    [&] {
                                                                      put_data(set, 7, {3, 4});
                                                                    }},
                                                                   {"all values", [&] { scale_data(set, 2); }},
                                                                   {"all phases", [&] { scale_data(set, -1); }},
                                                                   {"a place", [&] { put_u(set, 7, 1234); }}};
  for (const auto& [what, change] : changes) BOOST_TEST_CONTEXT(what) {
      std::ofstream(kept_in(output)) << kept;
      renew();
      change();
      BOOST_TEST(stopped_report_of(set, output, kept).find(going_on) == std::string::npos);
    }
}

BOOST_AUTO_TEST_CASE(results_are_read_as_they_were_written_by_their_owner_alone) {
  const TemporaryFolder folder;
  const std::string path = folder / "measured.json";
  PointResult measured = point("minimax", 0.125, 3e-7);
  measured.width = 7;
  measured.errors.predict_rms = NAN;
  measured.runs.push_back({.grid = 1, .fft = 2, .degrid = 3, .predict_fft = 4, .stretch = 7});
  PointResult refused;
  refused.point = {.kernel = "nearest", .accuracy = 1e-8};
  refused.refused = "out of reach";
  write_results(path, {{"vis", "a"}}, {measured, refused});
  std::vector<PointResult> found(3);
  found[0].point = refused.point;
  found[1].point = measured.point;
  const FoundResults of_others = read_results(path, {{"vis", "b"}, {"threads", 2}}, found);
  BOOST_TEST(of_others.runs == 0);
  BOOST_TEST(of_others.not_used == "it was measured with other threads, vis");
  BOOST_TEST(found[1].runs.empty());
  BOOST_TEST(read_results(path, {{"vis", "a"}}, found).runs == 2);
  BOOST_TEST(found[0].refused == "out of reach");
  BOOST_TEST(found[1].errors.rms == 3e-7);
  BOOST_TEST(std::isnan(found[1].errors.predict_rms));
  BOOST_TEST(found[1].runs.at(1).predict_fft == 4);
  BOOST_TEST(found[1].runs.at(1).stretch == 7);
  BOOST_TEST(found[2].runs.empty());
}

BOOST_AUTO_TEST_CASE(damaged_results_are_not_used) {
  const TemporaryFolder folder;
  const std::string path = folder / "measured.json";
  std::vector<PointResult> results{point("minimax", 0.125, 3e-7)};
  BOOST_TEST(read_results(path, {{"vis", "a"}}, results).not_used == "");  // there are none
  write_results(path, {{"vis", "a"}}, results);
  const std::string whole = content(path);
  results.front().runs.clear();
  std::string without_stretch = whole, without_time = whole;
  without_stretch.replace(whole.find("stretch"), 7, "stretcher");
  without_time.replace(whole.find("0.125"), 5, "null ");
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string(), std::string("[1]"), std::string("{}"),
                                     std::string(R"({"owner":7})"), without_stretch, without_time}) {
    std::ofstream(path) << damaged;
    const FoundResults found = read_results(path, {{"vis", "a"}}, results);
    BOOST_TEST(found.runs == 0);
    BOOST_TEST(found.not_used == "it is damaged", damaged);
    BOOST_TEST(results.front().runs.empty());
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_used_is_said_and_kept) {
  const TemporaryFolder folder;
  const std::string output = folder / "report";
  std::filesystem::create_directory(output);
  std::ofstream(kept_in(output)) << "cut of";
  const std::string said = stopped_report_of(snapshot(), output, "cut of");
  BOOST_TEST(said.find("measured.json is not used: it is damaged; it is kept as ") != std::string::npos, said);
  BOOST_TEST(content(kept_in(output) + ".old") == "cut of");
  const std::string kept = content(kept_in(output));
  Arguments other = short_report_of_scene(output);
  other[5] = "48";
  const Outcome outcome = run(other);
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(outcome.err.find("is not used: it was measured with other --imsize; it is kept") != std::string::npos,
             outcome.err);
  BOOST_TEST(content(kept_in(output) + ".old") == kept);
}

BOOST_AUTO_TEST_CASE(points_of_one_work_share_their_times) {
  std::vector<PointResult> results{point("least-misfit", 1, 1e-5), point("spheroidal", 3, 1e-3), point("minimax", 2, 1e-6)};
  results[1].work = results[0].work;
  results[2].runs.clear();
  const std::vector<PointResult> pooled = pooled_by_work(results);
  BOOST_REQUIRE(pooled.size() == 2);
  for (const PointResult& r : pooled) BOOST_TEST(image_seconds(r) == 2);
}

BOOST_AUTO_TEST_CASE(the_verdict_names_what_beats_least_misfit_kernels) {
  const std::vector<PointResult> ours{point("least-misfit", 1, 1e-4), point("minimax", 2, 1e-6), point("spheroidal", 3, 1e-5),
                                      point("spheroidal", 0.1, 1e-1)};
  BOOST_TEST(verdict_on(ours).find("2 least-misfit and minimax points alone") != std::string::npos);
  std::vector<PointResult> beaten = ours;
  beaten.push_back(point("kaiser-bessel", 1.25, 1e-5));
  const std::string verdict = verdict_on(beaten);
  BOOST_TEST(verdict.find("kaiser-bessel") != std::string::npos);
  BOOST_TEST(verdict.find("2 least-misfit and minimax points, and one other: kaiser-bessel") != std::string::npos, verdict);
  BOOST_TEST(verdict.find("takes 1.6 ± 0 times as long") != std::string::npos);
  beaten.push_back(point("spheroidal", 0.5, 5e-4));
  BOOST_TEST(verdict_on(beaten).find(", and others: kaiser-bessel") != std::string::npos);
  const std::vector<PointResult> alone{point("least-misfit", 1, 1e-4), point("minimax", 2, 1e-6)};
  BOOST_TEST(verdict_on(alone).find("nothing is compared") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_verdict_says_so_where_none_on_the_front_is_ours) {
  const std::vector<PointResult> results{point("least-misfit", 3, 1e-4), point("kaiser-bessel", 2, 1e-6)};
  BOOST_TEST(verdict_on(results).find("the front has none of least-misfit or minimax; it consists of: kaiser-bessel of") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_is_as_exact_but_for_the_choice_of_pixels_is_compared) {
  std::vector<PointResult> results{point("least-misfit", 1.5, 1.2e-4), point("minimax", 3, 1e-5),
                                   point("kaiser-bessel", 1, 1e-4)};
  BOOST_TEST(verdict_on(results).find("takes 3 ± 0 times") != std::string::npos);
  for (PointResult& r : results) r.errors.rms_noise = 0.1;
  BOOST_TEST(verdict_on(results).find("takes 1.5 ± 0 times") != std::string::npos);
  results[0] = point("least-misfit", 1, 1.2e-4);
  results[0].errors.rms_noise = 0.1;
  BOOST_TEST(verdict_on(results).find("takes as long but for noise, 1 ± 0 times") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(slow_stretches_change_neither_times_nor_their_noise) {
  // Of 20 points each of the first ten ran in all stretches, the others not in the first.
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  const double slow[]{1.3, 1, 1.3, 1, 1.3, 1, 1};
  std::vector<PointResult> results;
  for (int k = 0; k < 20; ++k) {
    results.push_back(point("minimax", 1 + 0.1 * k, 1e-6));
    results.back().runs.clear();
    for (int at = k < 10 ? 0 : 1; at < 7; ++at)
      results.back().runs.push_back({.grid = (1 + 0.1 * k) * slow[at] * (1 + noise(random)), .stretch = at});
  }
  const std::map<int, double> found = slowness(results);
  for (int at = 0; at < 7; ++at)
    BOOST_TEST(found.at(at) / found.at(1) == slow[at], boost::test_tools::tolerance(0.02));  // 4 σ of a median of ten
  const std::vector<PointResult> pooled = pooled_by_work(results);
  for (int k = 0; k < 20; ++k)
    BOOST_TEST(image_seconds(pooled[k]) / image_seconds(pooled[0]) == 1 + 0.1 * k, boost::test_tools::tolerance(0.03));
  for (const double part : time_noise(pooled, &SceneSeconds::image)) BOOST_TEST(part < 0.02);
  BOOST_TEST(words_on_speed(results).find("1.3 times as fast") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(stretches_that_share_no_point_are_compared_through_a_third) {
  // A report that was stopped early, and went on on a slower machine.
  std::vector<PointResult> results;
  for (int k = 0; k < 20; ++k) {
    results.push_back(point("minimax", 1 + 0.1 * k, 1e-6));
    const double seconds = 1 + 0.1 * k;
    results.back().runs = {{.grid = (k < 8 ? 1 : 1.5) * seconds, .stretch = k < 8 ? 0 : 1},
                           {.grid = 1.5 * seconds, .stretch = 2}};
  }
  const std::vector<PointResult> pooled = pooled_by_work(results);
  for (int k = 0; k < 20; ++k) BOOST_TEST(image_seconds(pooled[k]) == 1.5 * (1 + 0.1 * k), boost::test_tools::tolerance(1e-4));
}

BOOST_AUTO_TEST_CASE(a_stretch_of_few_runs_tells_nothing_of_the_machine) {
  std::vector<PointResult> results;
  for (int k = 0; k < 5; ++k) {
    results.push_back(point("minimax", 1 + k, 1e-6));
    results.back().runs = {{.grid = 1.0 + k, .stretch = 0}, {.grid = 1.0 + k, .stretch = 1}};
  }
  results.front().runs.push_back({.grid = 1.4, .stretch = 2});
  BOOST_TEST(slowness(results).at(2) == 1);
}

BOOST_AUTO_TEST_CASE(memory_for_the_visibilities_counts) {
  const TemporaryFolder folder;
  const std::string set = folder / "many.ms";
  succeed({"simulate", "--output", set, "--channels", "4000"});  // 1.4 million, of 28 bytes as data and prediction
  ImageOptions scene;
  scene.imsize = {64};
  scene.cell = "0.05arcsec";
  scene.memory_gib = 0.125;
  scene.vis = {snapshot()};
  BOOST_CHECK_NO_THROW(check_scene_memory(scene));
  scene.vis = {set};
  BOOST_CHECK_EXCEPTION(check_scene_memory(scene), std::invalid_argument, [](const std::exception& error) {
    return std::string(error.what()).find("of which visibilities take 0.04 GiB") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(times_are_as_uncertain_as_their_runs_differ) {
  std::vector<PointResult> results{point("minimax", 1, 1e-6), point("spheroidal", 2, 1e-3), point("least-misfit", 4, 1e-8)};
  results[0].runs = {{.grid = 0.9}, {.grid = 1}, {.grid = 1.1}, {.grid = 1.2}, {.grid = 0.8}};
  results[1].runs = {{.grid = 1.9}, {.grid = 2.1}};
  results[2].runs = {{.grid = 4}, {.grid = 4}};  // by chance
  const std::vector<double> noise = time_noise(results, &SceneSeconds::image);
  BOOST_TEST(noise[0] == 1.25 * 1.4826 * 0.1 / std::sqrt(5.0), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(noise[1] == 1.25 * 1.4826 * 0.05 / std::sqrt(2.0), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(noise[2] == noise[1]);
}

BOOST_AUTO_TEST_CASE(noisy_times_lead_to_no_verdict) {
  std::vector<PointResult> results{point("spheroidal", 1, 1e-5), point("minimax", 2, 1e-6)};
  for (PointResult& r : results) {
    const double seconds = r.runs.front().grid;
    r.runs = {{.grid = seconds}, {.grid = 1.4 * seconds}};
  }
  BOOST_TEST(verdict_on(results).find("too uncertain") != std::string::npos);
  BOOST_TEST(verdict_on(results).find("spheroidal") == std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
