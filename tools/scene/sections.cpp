#include "tools/scene/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/base/left_out.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"
#include "tools/run/selection_options.h"
#include "tools/run/weighting_options.h"
#include "tools/scene/pareto.h"
#include "tools/scene/timing.h"
#include "tools/scene/verdict.h"

namespace misfit::tools {
namespace {

/// The series that a point belongs to.
std::string family_label(const PointResult& r) {
  const bool other = r.point.evaluation != "polynomial";
  return r.point.kernel + (other ? ", other evaluation" : "");
}

/// A mark for each point, a series for each kernel.
std::vector<Series> scatter(const std::vector<PointResult>& results, const std::vector<CostAndError>& costs) {
  std::vector<Series> series;
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto [at, first] = place.emplace(family_label(results[i]), series.size());
    if (first) series.push_back({.label = at->first, .x = {}, .y = {}, .points = true, .line = false});
    series[at->second].x.push_back(costs[i].cost);
    series[at->second].y.push_back(costs[i].error);
  }
  return series;
}

/// The results on the front, the quickest first.
std::vector<std::size_t> along_front(const std::vector<CostAndError>& costs) {
  const std::vector<bool> front = pareto_front(costs);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (front[i]) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a].cost < costs[b].cost; });
  return order;
}

Figure error_figure(const std::string& name, const std::string& title, const std::string& caption,
                    const std::vector<PointResult>& results, const std::vector<CostAndError>& costs) {
  Figure figure{.name = name,
                .title = title,
                .caption = caption + " Broken: the Pareto front.",
                .x = {.label = "seconds", .logarithmic = true, .from = {}, .to = {}},
                .y = {.label = "RMS error", .logarithmic = true, .from = {}, .to = {}},
                .series = scatter(results, costs)};
  Series line{.label = "Pareto front", .x = {}, .y = {}, .law = true};
  for (const std::size_t i : along_front(costs)) {
    line.x.push_back(costs[i].cost);
    line.y.push_back(costs[i].error);
  }
  figure.series.push_back(line);
  if (costs.empty()) return figure;
  const auto [least, largest] = std::minmax_element(
      costs.begin(), costs.end(), [](const CostAndError& a, const CostAndError& b) { return a.cost < b.cost; });
  figure.x.from = least->cost / 1.2;
  figure.x.to = largest->cost * 1.2;
  return figure;
}

std::string command_of(const ImageOptions& scene, const ScenePoint& point) {
  std::string line = "misfit image --vis";
  for (const std::string& set : scene.vis) line += " " + shell_quoted(set);
  line += " --imagename image --imsize";
  for (const int side : scene.imsize) line += " " + std::to_string(side);
  const auto add = [&](const std::string& option, const std::string& value, const std::string& usual) {
    if (value != usual) line += " " + option + " " + shell_quoted(value);
  };
  line += " --cell " + scene.cell;
  for (const std::string& word : words_of(scene.selection)) line += " " + shell_quoted(word);
  add("--phasecenter", scene.phasecenter, "");
  add("--datacolumn", scene.datacolumn, "");
  for (const std::string& word : weighting_arguments(scene.weighting)) line += " " + shell_quoted(word);
  add("--gridder", scene.gridding.gridder, "auto");
  if (scene.force_average) line += " --force-average";
  add("--kernel-folder", scene.gridding.kernel.folder, "");
  return line + " " + options_text(point);
}

DataTable refused_table(const std::vector<PointResult>& results) {
  DataTable table{.name = "out-of-reach",
                  .title = "Out of reach",
                  .caption = "Points that no image can be made by, and why.",
                  .columns = {"point", "why"},
                  .rows = {},
                  .code = {"point"}};
  for (const PointResult& r : results)
    if (!r.refused.empty()) table.rows.push_back({options_text(r.point), r.refused});
  return table;
}

std::string width_text(const PointResult& r) {
  return std::to_string(r.width) + (r.width_w == 0 ? "" : " (w: " + std::to_string(r.width_w) + ")");
}

}  // namespace

ReportSection front_section(const ImageOptions& scene, const Scene& measured, const std::vector<PointResult>& all) {
  const std::vector<PointResult> results = pooled_by_work(all);
  const std::vector<CostAndError> costs = image_costs(results);
  DataTable table{
      .name = "front",
      .title = "The Pareto front",
      .caption =
          "No other point is both as exact and as quick, where times and errors that differ by less than their noise count as "
          "one. Seconds are of gridding, FFT and correction, in both passes where the plan needs two; the spread is from the "
          "quickest to the slowest run of all points whose operations are the same, over the median.",
      .columns = {"kernel", "width", "padding", "evaluation", "precision", "seconds", "spread", "RMS error", "largest error",
                  "expected", "command"},
      .rows = {},
      .code = {"command"}};
  for (const std::size_t i : along_front(costs)) {
    const PointResult& r = results[i];
    table.rows.push_back({r.point.kernel, width_text(r), r.padding, r.evaluation, r.precision, costs[i].cost, spread(r),
                          r.errors.rms, r.errors.max, r.expected_rms, command_of(scene, r.point)});
  }
  ReportSection section{
      .heading = "What is worth its time",
      .paragraphs = {verdict_on(results),
                     "Reading the visibilities took " + duration(measured.read_s()) + ", direct sums would take " +
                         duration(measured.direct_s()) + " for this image. The phase of w reaches " +
                         significant(measured.w_phase_rad(), 2) + " rad at its corners. Samples left out: " +
                         left_out_of_all(measured.truth().counts()) + " (" + left_out_reasons(measured.truth().counts()) + ").",
                     words_on_noise(results) + " " + words_on_speed(all)},
      .figures = {error_figure("image-error", "Error of the dirty image against the time it takes",
                               "RMS of the difference from the direct transform over the RMS of the image, at random "
                               "pixels of the whole image.",
                               results, costs),
                  error_figure("predict-error", "Error of predicted visibilities against the time they take",
                               "RMS of the difference from direct sums over the RMS of the visibilities, for a model of "
                               "points all over the image.",
                               results, predict_costs(results))},
      .tables = {table}};
  for (const std::string& warning : measured.warnings()) section.paragraphs.push_back("Warning: " + warning + ".");
  return section;
}

ReportSection theory_section(const std::vector<PointResult>& all) {
  const std::vector<PointResult> results = pooled_by_work(all);
  Figure figure{.name = "theory",
                .title = "What theory says, and what is measured",
                .caption =
                    "Measured RMS error of the dirty image against the expected one, and the strict bound, which holds "
                    "whatever the data. Broken: where measured and expected are equal.",
                .x = {.label = "expected RMS error", .logarithmic = true, .from = {}, .to = {}},
                .y = {.label = "RMS error", .logarithmic = true, .from = {}, .to = {}},
                .series = {}};
  Series is{.label = "measured", .x = {}, .y = {}, .points = true, .line = false};
  Series most{.label = "strict bound", .x = {}, .y = {}, .points = true, .line = false};
  Series equal{.label = "equal", .x = {}, .y = {}, .law = true};
  int within = 0, broken = 0;
  for (const PointResult& r : results) {
    is.x.push_back(r.expected_rms);
    is.y.push_back(r.errors.rms);
    most.x.push_back(r.expected_rms);
    most.y.push_back(r.bound_rms);
    const double ratio = r.errors.rms / r.expected_rms;
    within += ratio > 1 / 1.5 && ratio < 1.5 ? 1 : 0;
    broken += r.errors.rms > r.bound_rms || r.errors.max > r.bound_max ? 1 : 0;
  }
  if (!is.x.empty()) {
    const auto [least, largest] = std::minmax_element(is.x.begin(), is.x.end());
    equal.x = equal.y = {*least, *largest};
  }
  figure.series = {is, most, equal};
  const std::string count = std::to_string(results.size());
  return {.heading = "Errors that theory states",
          .paragraphs = {"The measured RMS lies within a factor 1.5 of the expected one at " + std::to_string(within) + " of " +
                         count +
                         " points; data are not random, and where they are few bright sources errors may be smaller or larger. "
                         "The strict bounds are " +
                         (broken == 0 ? "never exceeded." : "exceeded at " + std::to_string(broken) + " points.")},
          .figures = {figure},
          .tables = {}};
}

ReportSection programs_section(const ProgramComparison& programs) {
  DataTable table{
      .name = "programs",
      .title = "Whole programs, from MeasurementSet to FITS image",
      .caption = (programs.rounds == 1 ? "Wall clock of one run each"
                                       : "Wall clock, median of " + std::to_string(programs.rounds) + " runs by turns") +
                 "; misfit image makes a PSF, pictures and a report besides.",
      .columns = {"program", "seconds", "RMS error", "largest error", "RMS in the centre", "RMS at the border",
                  "RMS of prediction", "command"},
      .rows = {},
      .code = {"command"}};
  bool with_wsclean = false;
  for (const ProgramResult& p : programs.results) {
    with_wsclean = with_wsclean || p.words.front() == "wsclean";
    table.rows.push_back({p.failure.empty() ? p.name : p.name + ": failed, " + p.failure, median(p.seconds), p.errors.rms,
                          p.errors.max, p.errors.centre_rms, p.errors.border_rms, p.errors.predict_rms, p.command()});
  }
  if (with_wsclean)
    table.caption +=
        " WSClean weighs Stokes I by the smaller weight of both hands, so that errors are the gridders' own only where both "
        "weigh "
        "the same.";
  return {.heading = "Whole programs", .paragraphs = programs.left_out, .figures = {}, .tables = {table}};
}

ReportSection points_section(const ImageOptions& scene, const std::vector<PointResult>& all) {
  DataTable table{
      .name = "scene",
      .title = "Every point",
      .caption =
          "Errors are relative to the RMS of the image, or of the visibilities; centre: its inner half, border: "
          "within a sixteenth of its sides from its edge; noise: a standard error of an RMS, as a part of it. Seconds are "
          "medians, at the machine's usual speed.",
      .columns = {"kernel",       "width",         "x0",         "evaluation",    "precision",  "time_s",
                  "measured_rms", "measured_max",  "bound_rms",  "pareto",        "padding",    "width_w",
                  "expected_rms", "bound_max",     "centre_rms", "centre_max",    "border_rms", "border_max",
                  "predict_rms",  "predict_max",   "rms_noise",  "predict_noise", "grid_s",     "fft_s",
                  "degrid_s",     "predict_fft_s", "spread",     "memory_gib",    "passes",     "command"},
      .rows = {},
      .code = {"command"}};
  const std::vector<PointResult> results = pooled_by_work(all);
  const std::vector<bool> front = pareto_front(image_costs(results));
  for (std::size_t i = 0; i < results.size(); ++i) {
    const PointResult& r = results[i];
    const SceneErrors& e = r.errors;
    const auto stage = [&](double SceneSeconds::*of) {
      std::vector<double> seconds;
      for (const SceneSeconds& run : r.runs) seconds.push_back(run.*of);
      return median(seconds);
    };
    table.rows.push_back({r.point.kernel,
                          double(r.width),
                          r.x0,
                          r.evaluation,
                          r.precision,
                          image_seconds(r),
                          e.rms,
                          e.max,
                          r.bound_rms,
                          std::string(front[i] ? "yes" : "no"),
                          r.padding,
                          double(r.width_w),
                          r.expected_rms,
                          r.bound_max,
                          e.centre_rms,
                          e.centre_max,
                          e.border_rms,
                          e.border_max,
                          e.predict_rms,
                          e.predict_max,
                          e.rms_noise,
                          e.predict_noise,
                          stage(&SceneSeconds::grid),
                          stage(&SceneSeconds::fft),
                          stage(&SceneSeconds::degrid),
                          stage(&SceneSeconds::predict_fft),
                          spread(r),
                          r.memory_bytes / gib,
                          double(r.passes),
                          command_of(scene, r.point)});
  }
  ReportSection section{.heading = "Every point", .paragraphs = {}, .figures = {}, .tables = {table}};
  if (const auto late = all.size() - results.size() - refused_table(all).rows.size(); late > 0)
    section.paragraphs.push_back(
        "Left out, since --quick gives the first round two fifths of --seconds: " + std::to_string(late) + " more points.");
  if (const DataTable refused = refused_table(all); !refused.rows.empty()) section.tables.push_back(refused);
  return section;
}

}  // namespace misfit::tools
