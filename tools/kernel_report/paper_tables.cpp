#include <algorithm>
#include <chrono>
#include <cmath>

#include "kernels/catalogue.h"
#include "kernels/evaluation.h"
#include "kernels/lookup_table.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/evaluation_speed.h"
#include "tools/kernel_report/paper_statements.h"

namespace misfit::tools {
namespace {

using kernels::Interpolation;
using kernels::Precision;

std::string number(double value, int digits = 3) {
  return power_of_ten(value, digits);
}

/// √E of a table of the stored function, as it is.
double table_rms(const kernels::Kernel& kernel, const kernels::TableOptions& options) {
  const kernels::Evaluation way = kernels::evaluate_by_table(kernel.polynomial, options, Precision::double_precision);
  return std::sqrt(judge(way.taps, kernel.x0, way.judging()).mean);
}

/// The Ms whose table adds `part` of E, by the law of interpolation, which falls as Ms^−(2d+2).
double entries_for(double mean_error, Interpolation interpolation, double part = 1) {
  const double power = 2.0 * static_cast<int>(interpolation) + 2;
  return std::pow(kernels::table_misfit({1, interpolation}, paper_x0) / (part * mean_error), 1 / power);
}

Statement short_table(const kernels::LeastMisfit& three) {
  const kernels::Kernel spheroidal = kernels::kernel_family("spheroidal-exact").make(6, paper_x0);
  const kernels::Kernel kernel = store("least-misfit", three);
  const double linear = table_rms(kernel, {100, Interpolation::linear});
  const double nearest = table_rms(kernel, {200, Interpolation::nearest});
  const double casa = table_rms(spheroidal, {100, Interpolation::nearest});
  return {
      "§6.1", "W = 3 with a table of 300 entries", "as accurate as CASA",
      "√E = " + number(linear) + " (Ms = 100, linear) or " + number(nearest) +
          " (Ms = 200, nearest, half a table by symmetry); spheroidal W = 6, Ms = 100, nearest, as in CASA: " + number(casa),
      verdict(std::min(linear, nearest) <= casa, "W = 3 errs more")};
}

Statement hundred_entries(const kernels::LeastMisfit& seven) {
  const kernels::TableOptions hundred{100, Interpolation::nearest};
  const double ours = table_rms(store("least-misfit", seven), hundred);
  const double casa = table_rms(kernels::kernel_family("spheroidal-exact").make(6, paper_x0), hundred);
  return {"§6.1", "W = 7 with Ms = 100, nearest", "as accurate as CASA",
          "√E = " + number(ours) + "; spheroidal W = 6 with such a table " + number(casa),
          verdict(ours < 1.1 * casa, "it errs more")};
}

Statement entries_of_fourteen(const kernels::LeastMisfit& fourteen) {
  const double nearest = entries_for(fourteen.origin.mean_error, Interpolation::nearest);
  const double linear = entries_for(fourteen.origin.mean_error, Interpolation::linear);
  return {"§6.1", "W = 14: Ms for a table that errs as little as the function", "nearest 10¹², linear 10⁶",
          "nearest " + number(nearest) + ", linear " + number(linear) + ", where both err alike",
          verdict(nearest > 1e12 && linear > 1e6, "fewer do")};
}

Statement entries_of_seven(const kernels::LeastMisfit& seven) {
  const double error = seven.origin.mean_error;
  const double nearest = entries_for(error, Interpolation::nearest), linear = entries_for(error, Interpolation::linear);
  const auto within = [&](Interpolation interpolation) {
    return grouped(std::llround(std::ceil(entries_for(error, interpolation, 0.1))));
  };
  return {"App. F", "W = 7: Ms for a table that errs as little as the function", "nearest about 10⁶, linear about 10³",
          "both err alike at " + number(nearest) + " (nearest) and " + number(linear) +
              " (linear); E is within 10 % of the function's at nearest " + within(Interpolation::nearest) + ", linear " +
              within(Interpolation::linear) + ", quadratic " + within(Interpolation::quadratic) + ", cubic " +
              within(Interpolation::cubic),
          verdict(nearest > 3e5 && nearest < 3e6 && linear > 3e2 && linear < 3e3, "other orders of magnitude")};
}

Statement cubic_table(const kernels::LeastMisfit& seven) {
  const double entries = entries_for(seven.origin.mean_error, Interpolation::cubic, 0.1);
  return {"Tutorial", "W = 7: 64 entries a cell with cubic interpolation", "as good as exact values",
          std::to_string(std::llround(std::ceil(entries))) + " entries leave E within 10 %",
          verdict(entries <= 64, "more are needed")};
}

Statement table_size(int width, Precision precision, const char* stated, double stated_mb) {
  constexpr double entries_a_cell = 1e6, bytes_a_mb = 1024.0 * 1024;
  const bool single = precision == Precision::single_precision;
  const double bytes = width * entries_a_cell / 2 * (single ? sizeof(float) : sizeof(double));
  return {"§6.2",
          "W = " + std::to_string(width) + ", Ms = 10⁶: size of the table in " + (single ? "single" : "double") + " precision",
          stated, significant(bytes / bytes_a_mb, 4) + " MB of 2²⁰ bytes, half a table by symmetry",
          verdict(std::abs(bytes / bytes_a_mb / stated_mb - 1) < 1e-3, "another size")};
}

/// A table of 10⁶ entries a cell, and how long it took to solve and to fill.
struct TimedTable {
  kernels::Evaluation table;
  double solved_s = 0;
  double filled_s = 0;
};

TimedTable timed_table(int width, Precision precision) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const auto begin = Clock::now();
  const kernels::Kernel kernel = store("least-misfit", kernels::solve_least_misfit(width, paper_x0));
  const double solved_s = since(begin);
  const auto middle = Clock::now();
  kernels::Evaluation table = kernels::evaluate_by_table(kernel.polynomial, {1000000, Interpolation::nearest}, precision);
  return {std::move(table), solved_s, since(middle)};
}

Statement time_to_make(const TimedTable& made, int width, const char* stated) {
  return {"§6.2", "W = " + std::to_string(width) + ", Ms = 10⁶: time to make the table", stated,
          significant(made.solved_s, 2) + " s to solve, " + significant(made.filled_s, 2) + " s to fill it from polynomials",
          "polynomials fitted to the solution once make all entries, where the paper solves for each"};
}

Statement time_to_look_up(const TimedTable& seven, const kernels::Kernel& kernel) {
  const std::vector<double> ns = nanoseconds_a_visibility(
      {seven.table, kernels::evaluate_by_polynomial(kernel.polynomial, Precision::single_precision)}, {});
  return {"§6.2", "W = 7: time to find the 7 entries of a visibility", "0.38 µs",
          significant(ns[0] / 2e3, 2) + " µs in a table of Ms = 10⁶, " + significant(ns[1] / 2e3, 2) +
              " µs by polynomials, which take a few hundred bytes",
          "another machine"};
}

}  // namespace

std::vector<Statement> table_statements(SolvedKernels& solved) {
  const TimedTable seven = timed_table(7, Precision::single_precision);
  const TimedTable fourteen = timed_table(14, Precision::double_precision);
  return {hundred_entries(solved(7, paper_x0)),
          short_table(solved(3, paper_x0)),
          entries_of_fourteen(solved(14, paper_x0)),
          table_size(7, Precision::single_precision, "3.5 × 10⁶ numbers, 13.35 MB", 13.35),
          table_size(14, Precision::double_precision, "53.41 MB", 53.41),
          time_to_make(seven, 7, "12 s"),
          time_to_make(fourteen, 14, "104 s"),
          time_to_look_up(seven, store("least-misfit", solved(7, paper_x0))),
          entries_of_seven(solved(7, paper_x0)),
          cubic_table(solved(7, paper_x0))};
}

}  // namespace misfit::tools
