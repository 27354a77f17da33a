#include <algorithm>
#include <cmath>
#include <string>

#include "tools/base/numbers.h"
#include "tools/report/kernel_curves.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

constexpr int shown_widths[] = {4, 8, 12, 16, 20};

Series over_x0(const std::vector<RoundingLoss>& losses, int width, double (*measure)(const RoundingLoss&)) {
  Series series{.label = width_label(width), .x = {}, .y = {}, .points = true};
  for (const RoundingLoss& loss : losses) {
    if (loss.width != width) continue;
    series.x.push_back(loss.x0);
    series.y.push_back(measure(loss));
  }
  return series;
}

Figure limit_figure(const std::vector<RoundingLoss>& losses, Figure figure, double (*measure)(const RoundingLoss&)) {
  figure.x = {.label = "x₀", .from = 0, .to = 0.5};
  figure.y.logarithmic = true;
  for (const int width : shown_widths) figure.series.push_back(over_x0(losses, width, measure));
  return figure;
}

Figure stored_figure(const std::vector<RoundingLoss>& losses) {
  Figure figure{.name = "stored-limits",
                .title = "E of the polynomials that are stored",
                .caption =
                    "In doubles. Broken black lines are the floors that rounding of C to doubles sets, (2⁻⁵³ noise gain)², "
                    "lowest for W = 4: no function of doubles does much better. The optima continue below.",
                .x = {},
                .y = {.label = "E", .logarithmic = true, .from = 1e-34, .to = 1},
                .series = {}};
  figure = limit_figure(losses, figure, [](const RoundingLoss& l) { return l.stored_in_double; });
  for (const int width : {4, 12, 20}) {
    Series floor = over_x0(losses, width, [](const RoundingLoss& l) { return l.floor(); });
    floor.label = "floor, " + floor.label;
    floor.points = false;
    floor.law = true;
    figure.series.push_back(floor);
  }
  return figure;
}

const RoundingLoss& at(const std::vector<RoundingLoss>& losses, int width, double x0) {
  return *std::find_if(losses.begin(), losses.end(), [=](const RoundingLoss& l) { return l.width == width && l.x0 == x0; });
}

std::string towards_half(const std::vector<RoundingLoss>& losses) {
  const RoundingLoss& l = at(losses, 20, 0.49);
  return "At x₀ = ½ no function exists: ℓ(½) ≥ ½ for every C, since x = ½ and x = −½ are one point of the periodic image. "
         "Towards it "
         "h makes up for a C whose transform falls to 0, and amplifies its rounding as it does the signal. At W = 20, x₀ = "
         "0.49 the "
         "optimal E is " +
         power_of_ten(l.optimum.mean_error, 2) + ", h ranges over a factor of " + power_of_ten(l.correction_range, 2) +
         ", the noise gain is " + power_of_ten(l.noise_gain, 2) +
         ", and what the stored doubles reach is E = " + power_of_ten(l.stored_in_double, 2) + ".";
}

std::string best_at_049(const std::vector<RoundingLoss>& losses) {
  const RoundingLoss* best = nullptr;
  for (const RoundingLoss& l : losses)
    if (l.x0 == 0.49 && (best == nullptr || l.stored_in_double < best->stored_in_double)) best = &l;
  return "Of the widths tried, W = " + std::to_string(best->width) +
         " is the best at x₀ = 0.49 in doubles, with E = " + power_of_ten(best->stored_in_double, 2) + ".";
}

std::string towards_zero(const std::vector<RoundingLoss>& losses) {
  const RoundingLoss& l = at(losses, 8, 0.01);
  return "At tiny x₀ C has few cycles to tell its taps apart: at W = 8, x₀ = 0.01 the condition is " +
         power_of_ten(l.optimum.condition, 2) + ", solved in " + l.optimum.precision +
         ". h is flat, it ranges over a factor of " + significant(l.correction_range, 5) + ", and the noise gain is " +
         significant(l.noise_gain, 3) +
         ", so that storing the function in doubles still leaves E = " + power_of_ten(l.stored_in_double, 2) + ".";
}

}  // namespace

ReportSection limits_section(const std::vector<RoundingLoss>& losses) {
  ReportSection section{.heading = "Towards x₀ = ½ and x₀ = 0",
                        .paragraphs = {towards_half(losses), best_at_049(losses), towards_zero(losses)},
                        .figures = {},
                        .tables = {}};
  section.figures = {
      limit_figure(losses,
                   {.name = "optimal-limits",
                    .title = "The optimal E",
                    .caption = "As solved, before it is stored.",
                    .x = {},
                    .y = {.label = "E", .logarithmic = true, .from = {}, .to = 1},
                    .series = {}},
                   [](const RoundingLoss& l) { return l.optimum.mean_error; }),
      stored_figure(losses),
      limit_figure(losses,
                   {.name = "correction-range",
                    .title = "The range of h over |x| ≤ x₀",
                    .caption = "Largest over smallest.",
                    .x = {},
                    .y = {.label = "max h / min h", .logarithmic = true, .from = {}, .to = {}},
                    .series = {}},
                   [](const RoundingLoss& l) { return l.correction_range; }),
      limit_figure(losses,
                   {.name = "noise-gain",
                    .title = "How much rounding of the grid is amplified",
                    .caption = "√(mean of h²) √(∫ C² du): white noise on the grid, relative to the image of a visibility.",
                    .x = {},
                    .y = {.label = "noise gain", .logarithmic = true, .from = {}, .to = {}},
                    .series = {}},
                   [](const RoundingLoss& l) { return l.noise_gain; })};
  return section;
}

}  // namespace misfit::tools
