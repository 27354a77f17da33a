#include "tools/scene/scene_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "kernels/version.h"
#include "tools/base/interrupt.h"
#include "tools/base/numbers.h"
#include "tools/run/selection_options.h"
#include "tools/run/weighting_options.h"
#include "tools/scene/measure.h"
#include "tools/scene/programs.h"
#include "tools/scene/results_file.h"
#include "tools/scene/sections.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

/// Files that kernels come from, each with its time of last change.
json kernel_files(const SceneReportOptions& o) {
  json files = json::object();
  for (const std::string& kernel : o.kernels)
    if (const std::filesystem::path file = file_of({kernel, o.scene.gridding.kernel.folder}); !file.empty())
      files[std::filesystem::absolute(file).string()] = std::filesystem::last_write_time(file).time_since_epoch().count();
  return files;
}

std::vector<std::string> absolute(std::vector<std::string> paths) {
  for (std::string& path : paths) path = std::filesystem::absolute(path).string();
  return paths;
}

/// The owner of measurements, in names that people know: the samples, the image, the program's version and its threads.
json owner_of(const SceneReportOptions& o, const Scene& scene) {
  const ImageOptions& s = o.scene;
  return {{"version", MISFIT_VERSION},
          {"--vis", absolute(s.vis)},
          {"--phasecenter", s.phasecenter},
          {"number of samples", scene.samples()},
          {"visibilities", scene.fingerprint()},
          {"selection", words_of(s.selection)},
          {"--datacolumn", s.datacolumn},
          {"--imsize", s.imsize},
          {"--cell", s.cell},
          {"--weighting", weighting_text(s.weighting)},
          {"--gridder", s.gridding.gridder},
          {"--threads", scene.threads()},
          {"--quick", o.quick},
          {"files of kernels", kernel_files(o)}};
}

/// The effort for all points, run by turns.
struct Effort {
  std::size_t least_rounds;
  std::size_t most_rounds;
  double seconds;        ///< more rounds than the least while they take no more
  double first_round_s;  ///< after which the first round leaves the rest of the points out

  explicit Effort(const SceneReportOptions& o)
      : least_rounds(o.quick ? 2 : 5),
        most_rounds(o.quick ? 9 : 15),
        seconds(o.seconds > 0 ? o.seconds
                : o.quick     ? 75
                              : 600),
        first_round_s(o.quick ? 0.4 * seconds : HUGE_VAL) {}
};

/// The seconds of the first run of each point.
double first_round_seconds(const std::vector<PointResult>& results) {
  double seconds = 0;
  for (const PointResult& r : results)
    if (!r.runs.empty()) seconds += r.runs.front().image() + r.runs.front().predict();
  return seconds;
}

std::size_t rounds_within(const Effort& effort, const std::vector<PointResult>& results) {
  const double possible = effort.seconds / std::max(first_round_seconds(results), 1e-3);
  return static_cast<std::size_t>(
      std::clamp(possible, static_cast<double>(effort.least_rounds), static_cast<double>(effort.most_rounds)));
}

/// Fills `results` with the same measurements of an earlier run; returns the number of its runs. A useless file is put aside.
std::size_t resume(const std::string& path, const json& owner, std::vector<PointResult>& results, ProgressLine& progress) {
  const FoundResults found = read_results(path, owner, results);
  if (found.runs > 0) progress.say("going on from " + grouped(static_cast<long long>(found.runs)) + " runs in " + path);
  if (found.not_used.empty()) return found.runs;
  const std::string aside = path + ".old";
  std::filesystem::rename(path, aside);
  progress.say("warning: " + path + " is not used: " + found.not_used + "; it is kept as " + aside);
  return 0;
}

/// The number of a stretch that no run has.
int unused_stretch(const std::vector<PointResult>& results) {
  int unused = 0;
  for (const PointResult& r : results)
    for (const SceneSeconds& run : r.runs) unused = std::max(unused, run.stretch + 1);
  return unused;
}

/// The points in the order of a round: at first as they are, later at random, so that no two points always run at one time.
std::vector<PointResult*> in_order_of(std::size_t round, std::vector<PointResult>& results) {
  std::vector<PointResult*> order;
  for (PointResult& result : results) order.push_back(&result);
  std::mt19937_64 random(round);
  if (round > 0) std::shuffle(order.begin(), order.end(), random);
  return order;
}

void measure(const SceneReportOptions& o, Scene& scene, std::vector<PointResult>& results, ProgressLine& progress) {
  const Effort effort(o);
  const json owner = owner_of(o, scene);
  std::size_t done = resume(o.results_file, owner, results, progress);
  constexpr int runs_a_stretch = 12;  // less than a second, mostly
  int ran = runs_a_stretch * unused_stretch(results);
  const imager::Stopwatch watch;
  const double before_s = first_round_seconds(results);
  double written_s = -HUGE_VAL;
  const auto keep = [&](double every_s) {
    if (watch.seconds() - written_s < every_s) return;
    write_results(o.results_file, owner, results);
    written_s = watch.seconds();
  };
  const auto late = [&](std::size_t round) {
    constexpr std::size_t at_least = 10;  // two accuracies of each kernel: fewer points compare nothing
    if (round == 0) return done >= at_least && before_s + watch.seconds() > effort.first_round_s;
    return round >= effort.least_rounds && watch.seconds() > effort.seconds;
  };
  std::size_t rounds = effort.least_rounds;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (PointResult* const at : in_order_of(round, results)) {
      PointResult& result = *at;
      if (!result.refused.empty() || result.runs.size() != round || late(round)) continue;
      scene.run(result, ran / runs_a_stretch);
      if (result.refused.empty()) ++done, ++ran;
      const auto possible = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.refused.empty(); });
      keep(interrupted() ? 0 : 1);
      progress.update(done, rounds * static_cast<std::uint64_t>(possible));
    }
    keep(0);
    rounds = rounds_within(effort, results);
  }
}

}  // namespace

Report scene_report(const SceneReportOptions& o, ProgressLine& progress) {
  progress.begin("read, direct sums");
  Scene scene(o.scene, o.quick, [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); });
  progress.end();
  for (const std::string& warning : scene.warnings()) progress.say("warning: " + warning);
  std::vector<PointResult> results;
  for (const ScenePoint& point : scene_points(o.quick, o.kernels)) results.emplace_back().point = point;
  progress.begin("kernels");
  measure(o, scene, results, progress);
  progress.end();
  progress.begin("whole programs");
  const ProgramComparison programs = run_programs(o.scene, scene.truth(), scene.threads(), o.quick, progress);
  progress.end();
  const imager::ImageGeometry& g = scene.geometry();
  Report report{.title = "Error against run time",
                .introduction = names_of(o.scene.vis) + ": " + grouped(static_cast<long long>(scene.samples())) + " samples, " +
                                std::to_string(g.width) + " × " + std::to_string(g.height) + " pixels of " + o.scene.cell +
                                ", " + o.scene.datacolumn + ", weighting: " + weighting_text(o.scene.weighting) + ", " +
                                std::to_string(scene.threads()) + (scene.threads() == 1 ? " thread" : " threads") +
                                ". Every point is one way to make the dirty image, run by turns with the others.",
                .sections = {}};
  report.sections.push_back(front_section(o.scene, scene, results));
  report.sections.push_back(theory_section(results));
  report.sections.push_back(programs_section(programs));
  report.sections.push_back(points_section(o.scene, results));
  return report;
}

}  // namespace misfit::tools
