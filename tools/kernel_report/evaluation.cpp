#include "kernels/evaluation.h"

#include <array>
#include <cmath>
#include <limits>

#include "tools/base/numbers.h"
#include "tools/kernel_report/evaluation_speed.h"
#include "tools/kernel_report/kernel_report.h"

namespace misfit::tools {
namespace {

using kernels::Evaluation;
using kernels::Interpolation;
using kernels::Precision;

constexpr int table_width = 7;

struct Degree {
  Interpolation interpolation;
  const char* label;
  std::array<int, 4> samples;  ///< Ms whose ℓ(x) are drawn: from far above the function's own error to close to it
};
constexpr std::array<Degree, 4> degrees{{{Interpolation::nearest, "nearest", {16, 256, 4096, 65536}},
                                         {Interpolation::linear, "linear", {16, 64, 256, 1024}},
                                         {Interpolation::quadratic, "quadratic", {8, 16, 32, 64}},
                                         {Interpolation::cubic, "cubic", {4, 8, 16, 32}}}};

/// A table of the kernel, judged with the correction of the function itself.
struct JudgedTable {
  Evaluation way;
  kernels::JudgeOptions judging;
};
JudgedTable table_of(const kernels::Kernel& kernel, const kernels::TableOptions& options) {
  JudgedTable table{kernels::evaluate_by_table(kernel.polynomial, options, Precision::double_precision), {}};
  table.judging = table.way.judging();
  table.judging.correction = [taps = kernel.polynomial](const Eigen::VectorXd& x) {
    return kernels::optimal_correction(taps, x);
  };
  return table;
}

Figure map_error_of_tables(const kernels::Kernel& kernel, const Degree& degree) {
  Figure figure = map_error_figure(
      "table-" + std::string(degree.label),
      "Map error of lookup tables, " + std::string(degree.label) + " interpolation, W = 7, x₀ = 0.25", 1e-16, 1);
  figure.caption = "Ms is the number of entries a cell. The correction is that of the function.";
  for (const int samples : degree.samples) {
    const JudgedTable table = table_of(kernel, {samples, degree.interpolation});
    figure.series.push_back(map_error_curve("Ms = " + std::to_string(samples), table.way.taps, table.judging));
  }
  figure.series.push_back(map_error_curve("the function", kernel.polynomial));
  return figure;
}

/// √E against Ms by degree, and the law √(E + e²) as one broken curve.
Figure rms_of_tables(const kernels::Kernel& kernel) {
  Figure figure{.name = "table-rms",
                .title = "RMS error of lookup tables, W = 7, x₀ = 0.25",
                .caption =
                    "Marks are measured; the law is √(E + e²), e = κ (2πx₀)^(d+1) / (√(2d+3) Ms^(d+1)) for degree d, "
                    "κ = 0.28868, 0.091287, 0.046004, 0.029369, whatever the function.",
                .x = {.label = "Ms, entries a cell", .logarithmic = true},
                .y = {.label = "√E", .logarithmic = true},
                .series = {}};
  Series law{.label = "law", .x = {}, .y = {}, .law = true};
  for (const Degree& degree : degrees) {
    Series measured{.label = degree.label, .x = {}, .y = {}, .points = true, .line = false};
    for (int samples = 1; samples <= 4096; samples *= 2) {
      const JudgedTable table = table_of(kernel, {samples, degree.interpolation});
      measured.x.push_back(samples);
      measured.y.push_back(std::sqrt(judge(table.way.taps, paper_x0, table.judging).mean));
      law.x.push_back(samples);
      law.y.push_back(std::sqrt(kernel.misfit.mean + kernels::table_misfit({samples, degree.interpolation}, paper_x0)));
    }
    law.x.push_back(law.x.back());
    law.y.push_back(std::numeric_limits<double>::quiet_NaN());
    figure.series.push_back(measured);
  }
  figure.series.push_back(law);
  return figure;
}

DataTable ways_to_evaluate(const kernels::LeastMisfit& solution, const kernels::Kernel& kernel) {
  DataTable table{.name = "evaluation",
                  .title = "Ways to evaluate the function of W = 7, x₀ = 0.25",
                  .caption =
                      "E is what each really has, with the correction that is optimal for it; at the worst position of a "
                      "visibility in its cell, the mean over |x| ≤ x₀ and the largest squared error. Time is for the "
                      "taps of both axes on one core of this machine.",
                  .columns = {"way", "bytes", "E", "E / optimum", "worst ν, mean", "worst ν, max", "ns a visibility"},
                  .rows = {}};
  constexpr std::array<kernels::TableOptions, 5> shapes{{{65536, Interpolation::nearest},
                                                         {2048, Interpolation::linear},
                                                         {128, Interpolation::quadratic},
                                                         {32, Interpolation::cubic},
                                                         {64, Interpolation::cubic}}};
  std::vector<Evaluation> ways;
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    ways.push_back(kernels::evaluate_directly(solution, precision));
    for (const kernels::TableOptions& shape : shapes)
      ways.push_back(kernels::evaluate_by_table(kernel.polynomial, shape, precision));
    for (const int degree : {table_width - 1, table_width, table_width + 1, kernel.polynomial.degree()})
      ways.push_back(kernels::evaluate_by_polynomial(kernels::fit_polynomial(kernel.polynomial, degree), precision));
  }
  const std::vector<double> time_ns = nanoseconds_a_visibility(ways, {});
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const kernels::Misfit misfit = judge(ways[i].taps, paper_x0, ways[i].judging());
    table.rows.push_back({ways[i].name, static_cast<double>(ways[i].bytes), misfit.mean,
                          misfit.mean / solution.origin.mean_error, misfit.worst_mean, misfit.worst, time_ns[i]});
  }
  return table;
}

}  // namespace

ReportSection evaluation_section(SolvedKernels& solved) {
  const kernels::LeastMisfit& solution = solved(table_width, paper_x0);
  const kernels::Kernel kernel = store("least-misfit", solution);
  ReportSection section{
      .heading = "Tables and other ways to evaluate",
      .paragraphs = {"Tables are read between their entries by Newton's forward differences, without crossing "
                     "the jumps of C."},
      .figures = {},
      .tables = {ways_to_evaluate(solution, kernel)}};
  for (const Degree& degree : degrees) section.figures.push_back(map_error_of_tables(kernel, degree));
  section.figures.push_back(rms_of_tables(kernel));
  return section;
}

}  // namespace misfit::tools
