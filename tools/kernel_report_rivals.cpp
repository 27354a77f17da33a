#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/catalogue.h"
#include "tools/kernel_report.h"
#include "tools/numbers.h"

namespace misfit::tools {
namespace {

constexpr int narrowest = 4;
constexpr int widest = 16;

/// E and max ℓ of one family, W by W.
struct Errors {
  std::string label;
  std::vector<double> width;
  std::vector<double> mean;
  std::vector<double> max;
};

struct Rival {
  const char* family;
  const char* label;
};
constexpr std::array<Rival, 5> rivals{{{"spheroidal-exact", "spheroidal"},
                                       {"kaiser-bessel", "Kaiser–Bessel"},
                                       {"exp-semicircle", "exp of semicircle"},
                                       {"prolate", "prolate, order 0"},
                                       {"minimax", "minimax"}}};

/// What rounding leaves of E in doubles is some 3e-31; below this it would be seen.
constexpr double smallest_in_doubles = 1e-29;

Errors errors_of(const Rival& rival, double x0) {
  Errors errors{rival.label, {}, {}, {}};
  const kernels::KernelFamily family = kernels::kernel_family(rival.family);
  for (int width = narrowest; width <= std::min(widest, family.max_width); ++width) {
    const kernels::Origin origin = family.make(width, x0).origin;
    const bool rounded = origin.precision == "double" && origin.mean_error < smallest_in_doubles;
    errors.width.push_back(width);
    errors.mean.push_back(rounded ? std::nan("") : origin.mean_error);
    errors.max.push_back(rounded ? std::nan("") : origin.max_error);
  }
  return errors;
}

Errors least_misfit_errors(SolvedKernels& solved, double x0) {
  Errors errors{"least-misfit", {}, {}, {}};
  for (int width = narrowest; width <= widest; ++width) {
    errors.width.push_back(width);
    errors.mean.push_back(solved(width, x0).origin.mean_error);
    errors.max.push_back(solved(width, x0).origin.max_error);
  }
  return errors;
}

Series ratio_curve(const Errors& errors, const std::vector<double>& values, const std::vector<double>& best) {
  Series result{.label = errors.label, .x = errors.width, .y = {}, .points = true};
  for (std::size_t k = 0; k < values.size(); ++k) result.y.push_back(std::sqrt(values[k] / best[k]));
  return result;
}

Figure ratio_figure(const std::string& name, const std::string& title, const std::string& what) {
  return {.name = name,
          .title = title,
          .caption = "",
          .x = {.label = "width W", .from = narrowest - 0.5, .to = widest + 0.5},
          .y = {.label = what + ", over that of least-misfit", .logarithmic = true},
          .series = {}};
}

void add_figures(ReportSection& section, SolvedKernels& solved, double x0) {
  const std::string suffix = "-" + std::to_string(std::lround(100 * x0));
  const Errors best = least_misfit_errors(solved, x0);
  Figure rms = ratio_figure("rivals-rms" + suffix, "RMS of rivals, " + x0_label(x0), "√E");
  Figure max = ratio_figure("rivals-max" + suffix, "Largest error of rivals, " + x0_label(x0), "√(max ℓ)");
  rms.caption =
      "1 is the least-misfit function as wide; none can be below. What doubles cannot tell from rounding is left out.";
  max.caption =
      "In the largest error others win: below 1 lie functions that bound the worst place better than the least-misfit "
      "function does, minimax best of all.";
  DataTable table{.name = "rivals" + suffix,
                  .title = "Errors behind these figures, " + x0_label(x0),
                  .caption = "Least-misfit: √E and √(max ℓ); rivals: the same as multiples of these.",
                  .columns = {"W", "√E", "√(max ℓ)"},
                  .rows = {}};
  for (std::size_t k = 0; k < best.width.size(); ++k)
    table.rows.push_back({best.width[k], std::sqrt(best.mean[k]), std::sqrt(best.max[k])});
  for (const Rival& rival : rivals) {
    const Errors errors = errors_of(rival, x0);
    for (Figure* figure : {&rms, &max}) {
      figure->series.push_back(figure == &rms ? ratio_curve(errors, errors.mean, best.mean)
                                              : ratio_curve(errors, errors.max, best.max));
      table.columns.push_back(std::string(rival.label) + (figure == &rms ? ", √E" : ", max"));
      for (std::size_t k = 0; k < table.rows.size(); ++k) table.rows[k].emplace_back(figure->series.back().y.at(k));
    }
  }
  section.figures.push_back(rms);
  section.figures.push_back(max);
  section.tables.push_back(table);
}

}  // namespace

ReportSection rivals_section(SolvedKernels& solved) {
  ReportSection section{.heading = "Rivals against least-misfit",
                        .paragraphs = {"Kaiser–Bessel, the exponential of a semicircle and the prolate function have their one "
                                       "parameter tuned for the smallest E at each W and x₀; the spheroidal function (α = 1) "
                                       "has none. All get their optimal correction."},
                        .figures = {},
                        .tables = {}};
  for (const double x0 : {0.25, 0.4}) add_figures(section, solved, x0);
  return section;
}

}  // namespace misfit::tools
