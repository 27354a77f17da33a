#include "tools/scene/scene_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/base/numbers.h"
#include "tools/scene/measure.h"
#include "tools/scene/programs.h"
#include "tools/scene/results_file.h"
#include "tools/scene/sections.h"
#include "tools/version.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

/// What measurements belong to: the samples, the image, and who measured.
json owner_of(const SceneReportOptions& o, const Scene& scene) {
  const ImageOptions& s = o.scene;
  return {{"version", version},
          {"vis", std::filesystem::absolute(s.vis).string()},
          {"samples", scene.samples()},
          {"weight", scene.weight()},
          {"weight_abs", scene.weight_abs()},
          {"selection", {s.selection.field, s.selection.spectral_window}},
          {"datacolumn", s.datacolumn},
          {"imsize", s.imsize},
          {"cell", s.cell},
          {"gridder", s.gridder},
          {"threads", scene.threads()},
          {"quick", o.quick}};
}

void measure(const SceneReportOptions& o, Scene& scene, std::vector<PointResult>& results, ProgressLine& progress) {
  const json owner = owner_of(o, scene);
  const std::size_t rounds = o.quick ? 2 : 5;
  std::size_t done = read_results(o.results_file, owner, results);
  if (done > 0) progress.say("going on from " + grouped(static_cast<long long>(done)) + " runs in " + o.results_file);
  for (std::size_t round = 0; round < rounds; ++round) {
    for (PointResult& result : results) {
      if (!result.refused.empty() || result.runs.size() > round) continue;
      scene.run(result);
      if (result.refused.empty()) ++done;
      const auto possible = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.refused.empty(); });
      write_results(o.results_file, owner, results);
      progress.update(done, rounds * static_cast<std::uint64_t>(possible));
    }
  }
}

}  // namespace

Report scene_report(const SceneReportOptions& o, ProgressLine& progress) {
  progress.begin("read, direct sums");
  const int pixels = o.quick ? 128 : 512;
  Scene scene(o.scene, pixels, [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); });
  progress.end();
  std::vector<PointResult> results;
  for (const ScenePoint& point : scene_points(o.quick, o.kernels)) results.emplace_back().point = point;
  progress.begin("kernels");
  measure(o, scene, results, progress);
  progress.end();
  progress.begin("whole programs");
  const std::vector<ProgramResult> programs = run_programs(o.scene, scene.truth(), scene.threads(), o.quick ? 1 : 3, progress);
  progress.end();
  const imager::ImageGeometry& g = scene.geometry();
  Report report{.title = "Error against run time",
                .introduction = o.scene.vis + ": " + grouped(static_cast<long long>(scene.samples())) + " samples, " +
                                std::to_string(g.width) + " × " + std::to_string(g.height) + " pixels of " + o.scene.cell +
                                ", natural weighting, " + std::to_string(scene.threads()) +
                                " threads. Every point is one way to make the dirty image, run by turns with the others.",
                .sections = {}};
  report.sections.push_back(front_section(o.scene, scene, results));
  report.sections.push_back(theory_section(results));
  report.sections.push_back(programs_section(programs));
  report.sections.push_back(points_section(o.scene, results));
  return report;
}

}  // namespace misfit::tools
