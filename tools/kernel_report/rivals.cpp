#include <array>
#include <cmath>

#include "kernels/catalogue.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/kernel_report.h"

namespace misfit::tools {
namespace {

constexpr int narrowest = 4;
constexpr int widest_compared = 16;

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

/// In doubles rounding makes E some 3e-31 at least; below this value that would be seen.
constexpr double smallest_in_doubles = 1e-29;

Errors errors_of(const Rival& rival, double x0) {
  Errors errors{rival.label, {}, {}, {}};
  const kernels::KernelFamily family = kernels::kernel_family(rival.family);
  for (int width = narrowest; width <= widest_compared; ++width) {
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
  for (int width = narrowest; width <= widest_compared; ++width) {
    errors.width.push_back(width);
    errors.mean.push_back(solved(width, x0).origin.mean_error);
    errors.max.push_back(solved(width, x0).origin.max_error);
  }
  return errors;
}

/// One of the two ways to measure a function.
struct Norm {
  const char* name;
  const char* title;
  const char* symbol;
  const char* caption;
  std::vector<double> Errors::*values;
};
const std::array<Norm, 2> norms{
    {{"rms", "RMS error", "√E",
      "1 is the least-misfit function as wide; none can be below. What doubles cannot tell from rounding is left out.",
      &Errors::mean},
     {"max", "Largest error", "√(max ℓ)",
      "In the largest error minimax wins, which is made for that; the least-misfit function is made for the mean.",
      &Errors::max}}};

/// Least-misfit first.
using AllErrors = std::vector<Errors>;

Series ratio_curve(const Errors& errors, const Errors& best, const Norm& norm) {
  Series result{.label = errors.label, .x = errors.width, .y = {}, .points = true};
  for (std::size_t k = 0; k < result.x.size(); ++k)
    result.y.push_back(std::sqrt((errors.*norm.values)[k] / (best.*norm.values)[k]));
  return result;
}

std::string name_of(const Norm& norm, double x0) {
  return std::string("rivals-") + norm.name + "-" + std::to_string(std::lround(100 * x0));
}

Figure ratio_figure(const AllErrors& all, const Norm& norm, double x0) {
  Figure figure{.name = name_of(norm, x0),
                .title = norm.title + (" of rivals, " + x0_label(x0)),
                .caption = norm.caption,
                .x = {.label = "width W", .from = narrowest - 0.5, .to = widest_compared + 0.5},
                .y = {.label = norm.symbol + std::string(", over that of least-misfit"), .logarithmic = true},
                .series = {}};
  for (std::size_t k = 1; k < all.size(); ++k) figure.series.push_back(ratio_curve(all[k], all[0], norm));
  return figure;
}

DataTable errors_table(const AllErrors& all, const Norm& norm, double x0) {
  DataTable table{.name = name_of(norm, x0) + "-errors",
                  .title = norm.title + (", " + x0_label(x0)),
                  .caption = norm.symbol + std::string(", relative to the exact transform in one dimension."),
                  .columns = {"W"},
                  .rows = {}};
  for (const double width : all[0].width) table.rows.push_back({width});
  for (const Errors& errors : all) {
    table.columns.push_back(errors.label);
    for (std::size_t k = 0; k < table.rows.size(); ++k) table.rows[k].emplace_back(std::sqrt((errors.*norm.values)[k]));
  }
  return table;
}

}  // namespace

ReportSection rivals_section(SolvedKernels& solved) {
  ReportSection section{.heading = "Rivals against least-misfit",
                        .paragraphs = {"Kaiser–Bessel, the exponential of a semicircle and the prolate function have their one "
                                       "parameter tuned for the smallest E at each W and x₀; the spheroidal function (α = 1) "
                                       "has none. All get their optimal correction."},
                        .figures = {},
                        .tables = {}};
  for (const double x0 : {0.25, 0.4}) {
    AllErrors all{least_misfit_errors(solved, x0)};
    for (const Rival& rival : rivals) all.push_back(errors_of(rival, x0));
    for (const Norm& norm : norms) {
      section.figures.push_back(ratio_figure(all, norm, x0));
      section.tables.push_back(errors_table(all, norm, x0));
    }
  }
  return section;
}

}  // namespace misfit::tools
