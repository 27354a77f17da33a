#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/catalogue.h"
#include "kernels/evaluation.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/kernel_report.h"

namespace misfit::tools {
namespace {

using kernels::Interpolation;
using Row = std::vector<DataTable::Cell>;

std::string number(double value, int digits = 3) {
  return power_of_ten(value, digits);
}

std::string verdict(bool holds) {
  return holds ? "agrees" : "differs";
}

/// √E of a table of the stored function, as it is.
double table_rms(const kernels::Kernel& kernel, const kernels::TableOptions& options) {
  const kernels::Evaluation way = kernels::evaluate_by_table(kernel.polynomial, options, kernels::Precision::double_precision);
  return std::sqrt(judge(way.taps, kernel.x0, way.judging()).mean);
}

/// The smallest Ms that keeps E within a tenth of the function's own, by the law of interpolation.
int smallest_table(double mean_error, Interpolation interpolation) {
  const auto excess = [&](int samples) { return kernels::table_misfit({samples, interpolation}, paper_x0) / mean_error; };
  int low = 1;
  int high = 1 << 24;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (excess(middle) <= 0.1) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

Row largest_error_row(const kernels::LeastMisfit& seven) {
  const kernels::Origin minimax = kernels::kernel_family("minimax").make(7, paper_x0).origin;
  return {"W = 7, x₀ = 0.25: largest ℓ over |x| ≤ x₀", "below 10⁻¹⁴ everywhere",
          number(seven.origin.max_error) + ", at x = x₀; the smallest possible for W = 7 lies between " +
              number(minimax.max_error_bound) + " and " + number(minimax.max_error) + " (minimax)",
          verdict(seven.origin.max_error < 1e-14)};
}

Row widest_row(const kernels::LeastMisfit& twenty) {
  constexpr double stated = 6.62e-43;
  const double mean = twenty.origin.mean_error;
  return {"W = 20, x₀ = 0.25: misfit E", number(stated),
          number(mean, 4) + " as the mean over |x| ≤ x₀; its integral from 0 to x₀ is " + number(mean * paper_x0) +
              ", of which the paper's number is " + number(stated / (mean * paper_x0)) + " times",
          "differs: an integral, not a mean"};
}

Row spheroidal_row(const kernels::LeastMisfit& seven) {
  const kernels::Kernel spheroidal = kernels::kernel_family("spheroidal-exact").make(7, paper_x0);
  const double rms = std::sqrt(spheroidal.misfit.mean / seven.origin.mean_error);
  const double max = std::sqrt(spheroidal.misfit.max / seven.origin.max_error);
  return {"Against the spheroidal function, W = 7", "more than 100 times better",
          number(rms) + " times in RMS, " + number(max) + " times at the worst place", verdict(rms > 100 && max > 100)};
}

Row short_table_row(const kernels::LeastMisfit& three) {
  const kernels::Kernel spheroidal = kernels::kernel_family("spheroidal-exact").make(6, paper_x0);
  const kernels::Kernel kernel = store("least-misfit", three);
  const double linear = table_rms(kernel, {100, Interpolation::linear});
  const double nearest = table_rms(kernel, {200, Interpolation::nearest});
  const double casa = table_rms(spheroidal, {100, Interpolation::nearest});
  return {
      "W = 3 with a table of 300 entries", "accurate as CASA",
      "√E = " + number(linear) + " (Ms = 100, linear) or " + number(nearest) +
          " (Ms = 200, nearest, half a table by symmetry); spheroidal W = 6, Ms = 100, nearest, as in CASA: " + number(casa),
      verdict(std::min(linear, nearest) <= casa)};
}

std::string on_table(const kernels::LeastMisfit& solution, Interpolation interpolation) {
  return grouped(smallest_table(solution.origin.mean_error, interpolation));
}

Row table_size_row(const kernels::LeastMisfit& seven) {
  return {"W = 7: entries a cell, Ms, for E within 10 % of the function's",
          "64 with cubic interpolation is as good as exact values",
          "nearest " + on_table(seven, Interpolation::nearest) + ", linear " + on_table(seven, Interpolation::linear) +
              ", quadratic " + on_table(seven, Interpolation::quadratic) + ", cubic " + on_table(seven, Interpolation::cubic),
          verdict(smallest_table(seven.origin.mean_error, Interpolation::cubic) <= 64)};
}

Row machine_precision_row(SolvedKernels& solved) {
  int width = 1;
  while (std::sqrt(solved(width, paper_x0).origin.mean_error) > std::numeric_limits<double>::epsilon()) ++width;
  return {"Errors down to machine precision", "can be reached",
          "√E is below that of doubles, " + number(std::numeric_limits<double>::epsilon()) + ", from W = " +
              std::to_string(width) + " at x₀ = 0.25: " + number(std::sqrt(solved(width, paper_x0).origin.mean_error)),
          "agrees"};
}

}  // namespace

ReportSection paper_section(SolvedKernels& solved) {
  const kernels::LeastMisfit& seven = solved(7, paper_x0);
  const DataTable table{.name = "paper",
                        .title = "What the paper says and what we find",
                        .caption =
                            "Our numbers are computed by this run. The statement on table sizes is that of the authors' "
                            "published tutorial.",
                        .columns = {"statement", "the paper", "our numbers", ""},
                        .rows = {largest_error_row(seven), widest_row(solved(20, paper_x0)), spheroidal_row(seven),
                                 short_table_row(solved(3, paper_x0)), table_size_row(seven), machine_precision_row(solved)}};
  return {.heading = "The paper's statements", .paragraphs = {}, .figures = {}, .tables = {table}};
}

}  // namespace misfit::tools
