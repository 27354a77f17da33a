// misfit report scene: measured, and said of what was measured.
#include "tools/scene/scene_report.h"

#include <cerrno>
#include <functional>
#include <iterator>
#include <sstream>

#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"
#include "tools/scene/results_file.h"
#include "tools/scene/timing.h"
#include "tools/scene/verdict.h"

namespace {

using namespace misfit;
using namespace misfit::tools;
using namespace misfit::tools::testing;

Arguments report_of_scene(const std::string& output) {
  return {"report",    "scene",   "--vis",     snapshot(), "--imsize", "64",  "48", "--cell",
          "0.1arcsec", "--quick", "--seconds", "10000",    "--output", output};  // no point is left out on a slow machine
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

BOOST_AUTO_TEST_SUITE(scene_report)

BOOST_AUTO_TEST_CASE(every_point_is_measured_within_its_bounds_and_its_command_makes_it) {
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
  BOOST_TEST(on_front >= 2);
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
  // Other pixels of the same image: 384 and 3000 of 3072.
  BOOST_TEST(report["error"]["measured_rms"].get<double>() == std::stod(exact->at("measured_rms")),
             boost::test_tools::tolerance(0.25));
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
  const Outcome again = run(report_of_scene(folder / "report"));
  BOOST_TEST(again.code == 0);
  BOOST_TEST(again.err.find("going on from") != std::string::npos);
  BOOST_TEST(std::filesystem::exists(folder / "report/index.html"));
}

BOOST_AUTO_TEST_CASE(a_program_that_fails_is_said_and_the_rest_of_the_report_stays) {
  const TemporaryFolder folder;
  const Impostor wsclean("wsclean", "echo 'no such set today'\nexit 1\n");
  succeed(report_of_scene(folder / "report"));
  BOOST_TEST(rows_of(folder / "report/scene.csv").size() > 50);
  std::istringstream programs(content(folder / "report/programs.csv"));
  int failed = 0, made = 0;
  for (std::string line; std::getline(programs, line);) {
    failed +=
        line.find("wsclean") != std::string::npos && line.find(": failed, no such set today") != std::string::npos ? 1 : 0;
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
  const Arguments arguments = report_of_scene(folder / "report");  // makes folders that outlive this test
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
  measured.runs.push_back({.grid = 1, .fft = 2, .degrid = 3, .predict_fft = 4});
  PointResult refused;
  refused.point = {.kernel = "nearest", .accuracy = 1e-8};
  refused.refused = "out of reach";
  write_results(path, {{"vis", "a"}}, {measured, refused});
  std::vector<PointResult> found(3);
  found[0].point = refused.point;
  found[1].point = measured.point;
  BOOST_TEST(read_results(path, {{"vis", "b"}}, found) == 0);
  BOOST_TEST(found[1].runs.empty());
  BOOST_TEST(read_results(path, {{"vis", "a"}}, found) == 2);
  BOOST_TEST(found[0].refused == "out of reach");
  BOOST_TEST(found[1].errors.rms == 3e-7);
  BOOST_TEST(std::isnan(found[1].errors.predict_rms));
  BOOST_TEST(found[1].runs.at(1).predict_fft == 4);
  BOOST_TEST(found[2].runs.empty());
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
  BOOST_TEST(verdict.find("takes 1.6 ± 0 times as long") != std::string::npos);
  const std::vector<PointResult> alone{point("least-misfit", 1, 1e-4), point("minimax", 2, 1e-6)};
  BOOST_TEST(verdict_on(alone).find("nothing is compared") != std::string::npos);
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
