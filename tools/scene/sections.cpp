#include "tools/scene/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"
#include "tools/scene/pareto.h"

namespace misfit::tools {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

template <typename Of>
double median_of(const PointResult& result, const Of& of) {
  std::vector<double> values;
  for (const SceneSeconds& run : result.runs) values.push_back(of(run));
  return median(values);
}

double predict_seconds(const PointResult& r) {
  return median_of(r, [](const SceneSeconds& s) { return s.predict(); });
}

/// (slowest − fastest) / median.
double spread(const PointResult& r) {
  const auto less = [](const SceneSeconds& a, const SceneSeconds& b) { return a.image() < b.image(); };
  const auto [least, most] = std::minmax_element(r.runs.begin(), r.runs.end(), less);
  return (most->image() - least->image()) / image_seconds(r);
}

/// The series that a point belongs to.
std::string family_label(const PointResult& r) {
  const bool other = r.point.evaluation != "polynomial";
  return r.point.kernel + (other ? ", other evaluation" : "");
}

using Quantity = double (*)(const PointResult&);

double image_error(const PointResult& r) {
  return r.errors.rms;
}
double predict_error(const PointResult& r) {
  return r.errors.predict_rms;
}

/// A mark for each point, a series for each kernel.
std::vector<Series> scatter(const std::vector<PointResult>& results, Quantity x, Quantity y) {
  std::vector<Series> series;
  std::map<std::string, std::size_t> place;
  for (const PointResult& r : results) {
    const auto [at, first] = place.emplace(family_label(r), series.size());
    if (first) series.push_back({.label = at->first, .x = {}, .y = {}, .points = true, .line = false});
    series[at->second].x.push_back(x(r));
    series[at->second].y.push_back(y(r));
  }
  return series;
}

Series front_line(const std::vector<PointResult>& results, Quantity seconds, Quantity error) {
  std::vector<CostAndError> of;
  for (const PointResult& r : results) of.push_back({seconds(r), error(r)});
  const std::vector<bool> front = pareto_front(of, time_noise(results));
  std::vector<CostAndError> on;
  for (std::size_t i = 0; i < of.size(); ++i)
    if (front[i]) on.push_back(of[i]);
  std::sort(on.begin(), on.end(), [](const CostAndError& a, const CostAndError& b) { return a.cost < b.cost; });
  Series line{.label = "Pareto front", .x = {}, .y = {}, .law = true};
  for (const CostAndError& p : on) {
    line.x.push_back(p.cost);
    line.y.push_back(p.error);
  }
  return line;
}

Figure error_figure(const std::string& name, const std::string& title, const std::string& caption,
                    const std::vector<PointResult>& results, Quantity seconds, Quantity error) {
  Figure figure{.name = name,
                .title = title,
                .caption = caption,
                .x = {.label = "seconds", .logarithmic = true, .from = {}, .to = {}},
                .y = {.label = "RMS error", .logarithmic = true, .from = {}, .to = {}},
                .series = scatter(results, seconds, error)};
  figure.series.push_back(front_line(results, seconds, error));
  std::vector<double> all;
  for (const PointResult& r : results) all.push_back(seconds(r));
  if (!all.empty()) {
    const auto [least, largest] = std::minmax_element(all.begin(), all.end());
    figure.x.from = *least / 1.2;
    figure.x.to = *largest * 1.2;
  }
  return figure;
}

std::string command_of(const ImageOptions& scene, const ScenePoint& point) {
  std::string line = "misfit image --vis " + shell_quoted(scene.vis) + " --imagename image --imsize";
  for (const int side : scene.imsize) line += " " + std::to_string(side);
  const auto add = [&](const std::string& option, const std::string& value, const std::string& usual) {
    if (value != usual) line += " " + option + " " + shell_quoted(value);
  };
  line += " --cell " + scene.cell;
  add("--field", scene.selection.field, "");
  add("--spw", scene.selection.spectral_window, "");
  add("--datacolumn", scene.datacolumn, "data");
  add("--gridder", scene.gridder, "auto");
  return line + " " + options_text(point);
}

std::string width_text(const PointResult& r) {
  return std::to_string(r.width) + (r.width_w == 0 ? "" : " (w: " + std::to_string(r.width_w) + ")");
}

bool is_ours(const PointResult& r) {
  return r.point.kernel == "least-misfit" || r.point.kernel == "minimax";
}

/// How much longer the quickest of our points takes that is as exact.
double ours_over(const PointResult& other, const std::vector<PointResult>& results) {
  double least = std::numeric_limits<double>::infinity();
  for (const PointResult& r : results)
    if (is_ours(r) && r.errors.rms <= other.errors.rms) least = std::min(least, image_seconds(r));
  return least / image_seconds(other);
}

}  // namespace

double image_seconds(const PointResult& result) {
  return median_of(result, [](const SceneSeconds& s) { return s.image(); });
}

std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results) {
  std::map<std::string, std::vector<SceneSeconds>> runs;
  for (const PointResult& r : results) runs[r.work].insert(runs[r.work].end(), r.runs.begin(), r.runs.end());
  std::vector<PointResult> found;
  for (const PointResult& r : results) {
    if (r.runs.empty()) continue;
    found.push_back(r);
    found.back().runs = runs[r.work];
  }
  return found;
}

double time_noise(const std::vector<PointResult>& results) {
  std::vector<double> noise;
  for (const PointResult& r : results) noise.push_back(spread(r) / (2 * std::sqrt(static_cast<double>(r.runs.size()))));
  constexpr double most = 0.1;  // times that are known worse than that are no reason to call all equal
  return noise.empty() ? 0 : std::min(median(noise), most);
}

std::vector<bool> front_of(const std::vector<PointResult>& results) {
  std::vector<CostAndError> of;
  for (const PointResult& r : results) of.push_back({image_seconds(r), r.errors.rms});
  return pareto_front(of, time_noise(results));
}

std::string verdict_on(const std::vector<PointResult>& results) {
  const std::vector<bool> front = front_of(results);
  int ours = 0;
  std::string others;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const PointResult& r = results[i];
    if (!front[i] || r.errors.rms > 1e-3 || r.errors.rms < 1e-7) continue;
    if (is_ours(r)) {
      ++ours;
      continue;
    }
    const double longer = ours_over(r, results);
    others += (others.empty() ? "" : "; ") + r.point.kernel + " of width " + std::to_string(r.width) + " at " +
              power_of_ten(r.errors.rms, 2) + ", where the next least-misfit or minimax point as exact " +
              (std::isfinite(longer) ? "takes " + significant(longer, 3) + " times as long" : "was not among the points");
  }
  if (ours == 0 && others.empty()) return "No point of the front lies between 10⁻³ and 10⁻⁷.";
  const std::string count = std::to_string(ours) + " least-misfit and minimax point" + (ours == 1 ? "" : "s");
  if (others.empty()) return "From 10⁻³ to 10⁻⁷ the front consists of " + count + " alone.";
  return "From 10⁻³ to 10⁻⁷ the front has " + count + ", and others: " + others + ".";
}

ReportSection front_section(const ImageOptions& scene, const Scene& measured, const std::vector<PointResult>& all) {
  const std::vector<PointResult> results = pooled_by_work(all);
  const std::vector<bool> front = front_of(results);
  DataTable table{
      .name = "front",
      .title = "The Pareto front",
      .caption =
          "No other point is both as exact and as quick, where times that differ by less than their noise count as one. "
          "Seconds are of gridding, FFT and correction; the "
          "spread is from the quickest to the slowest run of all points whose operations are the same, over the median.",
      .columns = {"kernel", "width", "padding", "evaluation", "precision", "seconds", "spread", "RMS error", "largest error",
                  "expected", "command"},
      .rows = {},
      .code = {"command"}};
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (front[i]) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return image_seconds(results[a]) < image_seconds(results[b]); });
  for (const std::size_t i : order) {
    const PointResult& r = results[i];
    table.rows.push_back({r.point.kernel, width_text(r), r.padding, r.evaluation, r.precision, image_seconds(r), spread(r),
                          r.errors.rms, r.errors.max, r.expected_rms, command_of(scene, r.point)});
  }
  ReportSection section{
      .heading = "What is worth its time", .paragraphs = {verdict_on(results)}, .figures = {}, .tables = {table}};
  section.paragraphs.push_back("Reading the visibilities took " + duration(measured.read_s()) + ", direct sums would take " +
                               duration(measured.direct_s()) + " for this image. The phase of w reaches " +
                               significant(measured.w_phase_rad(), 2) + " rad at its corners. Times that differ by less than " +
                               significant(100 * time_noise(results), 2) + " % count as equal here.");
  section.figures = {
      error_figure(
          "image-error", "Error of the dirty image against the time it takes",
          "RMS of the difference from the direct transform over the RMS of the image, at random pixels of the whole image. "
          "Broken: the Pareto front.",
          results, image_seconds, image_error),
      error_figure(
          "predict-error", "Error of predicted visibilities against the time they take",
          "RMS of the difference from direct sums over the RMS of the visibilities, for a model of points all over the "
          "image. Broken: the Pareto front.",
          results, predict_seconds, predict_error)};
  return section;
}

ReportSection theory_section(const std::vector<PointResult>& all) {
  const std::vector<PointResult> results = pooled_by_work(all);
  const Quantity expected = [](const PointResult& r) { return r.expected_rms; };
  const Quantity bound = [](const PointResult& r) { return r.bound_rms; };
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
    is.x.push_back(expected(r));
    is.y.push_back(image_error(r));
    most.x.push_back(expected(r));
    most.y.push_back(bound(r));
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

ReportSection programs_section(const std::vector<ProgramResult>& programs) {
  DataTable table{.name = "programs",
                  .title = "Whole programs, from MeasurementSet to FITS image",
                  .caption =
                      "Wall clock, median of runs by turns; misfit image makes a PSF, pictures and a report besides. WSClean "
                      "weighs Stokes I by the smaller weight of both hands, so that errors are the gridders' own only where "
                      "both weigh the same.",
                  .columns = {"program", "seconds", "RMS error", "largest error", "RMS in the centre", "RMS at the border",
                              "RMS of prediction", "command"},
                  .rows = {},
                  .code = {"command"}};
  for (const ProgramResult& p : programs)
    table.rows.push_back({p.failure.empty() ? p.name : p.name + ": failed, " + p.failure, median(p.seconds), p.errors.rms,
                          p.errors.max, p.errors.centre_rms, p.errors.border_rms, p.errors.predict_rms, p.command()});
  return {.heading = "Whole programs", .paragraphs = {}, .figures = {}, .tables = {table}};
}

ReportSection points_section(const ImageOptions& scene, const std::vector<PointResult>& all) {
  DataTable table{.name = "scene",
                  .title = "Every point",
                  .caption =
                      "Errors are relative to the RMS of the image, or of the visibilities; centre: its inner half, border: "
                      "within a sixteenth of its sides from its edge. Seconds are medians.",
                  .columns = {"kernel",       "width",        "x0",         "evaluation", "precision",  "time_s",
                              "measured_rms", "measured_max", "bound_rms",  "pareto",     "padding",    "width_w",
                              "expected_rms", "bound_max",    "centre_rms", "centre_max", "border_rms", "border_max",
                              "predict_rms",  "predict_max",  "grid_s",     "fft_s",      "degrid_s",   "predict_fft_s",
                              "spread",       "memory_gib",   "command"},
                  .rows = {},
                  .code = {"command"}};
  const std::vector<PointResult> results = pooled_by_work(all);
  const std::vector<bool> front = front_of(results);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const PointResult& r = results[i];
    const SceneErrors& e = r.errors;
    const auto stage = [&](double SceneSeconds::*of) { return median_of(r, [of](const SceneSeconds& s) { return s.*of; }); };
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
                          stage(&SceneSeconds::grid),
                          stage(&SceneSeconds::fft),
                          stage(&SceneSeconds::degrid),
                          stage(&SceneSeconds::predict_fft),
                          spread(r),
                          r.memory_bytes / gib,
                          command_of(scene, r.point)});
  }
  ReportSection section{.heading = "Every point", .paragraphs = {}, .figures = {}, .tables = {table}};
  std::string refused;
  for (const PointResult& r : all)
    if (!r.refused.empty()) refused += (refused.empty() ? "" : "; ") + options_text(r.point) + " (" + r.refused + ")";
  if (!refused.empty()) section.paragraphs.push_back("Out of reach: " + refused + ".");
  return section;
}

}  // namespace misfit::tools
