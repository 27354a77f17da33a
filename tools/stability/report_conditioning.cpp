#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "kernels/conditioning.h"
#include "kernels/map_error.h"
#include "tools/base/numbers.h"
#include "tools/report/kernel_curves.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

constexpr double unit = 0x1p-53;       // half a unit in the last place of 1 in double
constexpr double lost = 1.5;           // E over its optimum from which a method counts as lost
constexpr int steps_of_rounding = 64;  // see kernels::JudgeOptions

const std::vector<int> widths{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 20};
const std::vector<double> fractions{0.01, 0.03, 0.1, 0.2, 0.25, 0.3, 0.4, 0.45, 0.47, 0.49};
const std::vector<double> quick_fractions{0.01, 0.25, 0.49};

/// All x0 of the losses, in order.
std::vector<double> fractions_of(const std::vector<RoundingLoss>& losses) {
  std::vector<double> found;
  for (const RoundingLoss& l : losses)
    if (found.empty() || found.back() != l.x0) found.push_back(l.x0);
  return found;
}

using Measure = std::function<double(const RoundingLoss&)>;

RoundingLoss rounding_loss(int width, double x0) {
  const kernels::LeastMisfit solution = kernels::solve_least_misfit(width, x0);
  const kernels::Kernel stored = kernels::make_kernel("least-misfit", x0, solution.taps, solution.origin);
  const kernels::Correction h = [&](const Eigen::VectorXd& x) { return kernels::optimal_correction(solution.taps, x); };
  RoundingLoss loss{.width = width, .x0 = x0, .optimum = solution.origin};
  loss.normal_equations = kernels::judge(kernels::solve_by_normal_equations(width, x0, h), x0).mean;
  loss.orthogonal = kernels::judge(kernels::solve_by_orthogonal_factors(width, x0, h), x0).mean;
  loss.stored_in_double = stored.misfit.mean;
  loss.stored_in_single = kernels::judge(kernels::stored_in_single(stored.polynomial), x0, {steps_of_rounding, {}}).mean;
  loss.noise_gain = kernels::noise_gain(stored.polynomial, x0);
  const Eigen::VectorXd correction = kernels::optimal_correction(stored.polynomial, Eigen::VectorXd::LinSpaced(101, 0, x0));
  loss.correction_range = correction.maxCoeff() / correction.minCoeff();
  return loss;
}

/// A curve for each x0 over the widths.
Figure over_widths(const std::vector<RoundingLoss>& losses, Figure figure, const Measure& measure) {
  figure.x = {.label = "W, cells", .from = 1, .to = widths.back()};
  figure.y.logarithmic = true;
  for (const double x0 : fractions_of(losses)) {
    Series series{.label = x0_label(x0), .x = {}, .y = {}, .points = true};
    for (const RoundingLoss& loss : losses) {
      if (loss.x0 != x0) continue;
      series.x.push_back(loss.width);
      series.y.push_back(measure(loss));
    }
    figure.series.push_back(series);
  }
  return figure;
}

Figure excess_figure(const std::vector<RoundingLoss>& losses, Figure figure, double RoundingLoss::*error) {
  figure.y = {.label = "E / optimal E", .from = 0.5, .to = 1e12};
  figure.caption += " Beyond 10¹² the curves leave the figure; the CSV file has them.";
  return over_widths(losses, std::move(figure), [error](const RoundingLoss& l) { return l.*error / l.optimum.mean_error; });
}

/// The narrowest width at which `is_lost`; a gap where none is.
double first_width(const std::vector<RoundingLoss>& losses, double x0,
                   const std::function<bool(const RoundingLoss&)>& is_lost) {
  for (const RoundingLoss& loss : losses)
    if (loss.x0 == x0 && is_lost(loss)) return loss.width;
  return std::numeric_limits<double>::quiet_NaN();
}

DataTable onsets(const std::vector<RoundingLoss>& losses) {
  DataTable table{
      .name = "onsets",
      .title = "The width from which each arithmetic loses",
      .caption = "The narrowest W at which E exceeds " + significant(lost, 2) +
                 " times its optimum; empty where that does not happen to W = 20. The rule is where ε² times the "
                 "condition reaches the optimal E, ε = 2⁻⁵²; it leaves out the range of h, which counts towards x₀ = ½.",
      .columns = {"x₀", "normal equations", "the rule for them", "QR", "stored in double", "stored in single"},
      .rows = {}};
  const auto first = [&](double x0, double RoundingLoss::*error) {
    return first_width(losses, x0, [error](const RoundingLoss& l) { return l.*error > lost * l.optimum.mean_error; });
  };
  for (const double x0 : fractions_of(losses)) {
    const double rule = first_width(
        losses, x0, [](const RoundingLoss& l) { return 4 * unit * unit * l.optimum.condition >= l.optimum.mean_error; });
    std::vector<DataTable::Cell>& row = table.rows.emplace_back();  // one by one: g++ 12 takes a list for uninitialised
    row.emplace_back(x0);
    row.emplace_back(first(x0, &RoundingLoss::normal_equations));
    row.emplace_back(rule);
    for (const auto error : {&RoundingLoss::orthogonal, &RoundingLoss::stored_in_double, &RoundingLoss::stored_in_single})
      row.emplace_back(first(x0, error));
  }
  return table;
}

DataTable all_losses(const std::vector<RoundingLoss>& losses) {
  DataTable table{.name = "losses",
                  .title = "All of it at x₀ = 0.25",
                  .caption =
                      "E of each. Below the floor, (2⁻⁵³ noise gain)², neither doubles hold a function nor can judging in "
                      "doubles tell.",
                  .columns = {"W", "optimal E", "arithmetic", "condition", "normal equations", "QR", "stored in double",
                              "stored in single", "floor"},
                  .rows = {}};
  for (const RoundingLoss& l : losses) {
    if (l.x0 != 0.25) continue;
    table.rows.push_back({static_cast<double>(l.width), l.optimum.mean_error, l.optimum.precision, l.optimum.condition,
                          l.normal_equations, l.orthogonal, l.stored_in_double, l.stored_in_single, l.floor()});
  }
  return table;
}

/// The best E that any double storage reached where the optimum lies far below: what the page says of the floor.
double smallest_stored(const std::vector<RoundingLoss>& losses) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const RoundingLoss& l : losses) smallest = std::min(smallest, l.stored_in_double);
  return smallest;
}

}  // namespace

double RoundingLoss::floor() const {
  return unit * unit * noise_gain * noise_gain;
}

std::vector<RoundingLoss> rounding_losses(bool quick, ProgressLine& progress) {
  const std::vector<double>& of = quick ? quick_fractions : fractions;
  std::vector<RoundingLoss> losses;
  progress.begin("solve and judge");
  // The time of a solution grows steeply with the width: count in such units.
  const auto work = [](std::uint64_t width) { return width * width * width; };
  std::uint64_t row = 0;
  for (const int width : widths) row += work(static_cast<std::uint64_t>(width));
  std::uint64_t done = 0;
  for (const double x0 : of) {
    for (const int width : widths) {
      progress.update(done, row * of.size());
      losses.push_back(rounding_loss(width, x0));
      done += work(static_cast<std::uint64_t>(width));
    }
  }
  progress.end();
  return losses;
}

ReportSection conditioning_section(const std::vector<RoundingLoss>& losses) {
  ReportSection section{
      .heading = "Solving and storing C", .paragraphs = {}, .figures = {}, .tables = {onsets(losses), all_losses(losses)}};
  section.paragraphs = {
      "For a given h, C solves a least-squares problem for every position t of a visibility in its cell. Its normal equations "
      "have the square of the design matrix's condition; QR of that matrix does not. Both were solved here in doubles for the "
      "optimal h, and the taps judged.",
      "Taps that are doubles, and a judge that computes in doubles, have a floor of their own: the smallest E here is " +
          power_of_ten(smallest_stored(losses), 2) +
          ". Where the optimum is smaller, each of these ratios says how far the optimum lies below doubles, which is why such "
          "functions are solved in wider arithmetic, and what storing them in doubles loses."};
  section.figures = {over_widths(losses,
                                 {.name = "condition",
                                  .title = "Condition of the normal equations for C",
                                  .caption = "In the 2-norm, at the optimal h.",
                                  .x = {},
                                  .y = {.label = "condition number", .logarithmic = true, .from = {}, .to = {}},
                                  .series = {}},
                                 [](const RoundingLoss& l) { return l.optimum.condition; }),
                     excess_figure(losses,
                                   {.name = "normal-equations",
                                    .title = "C by the normal equations in double",
                                    .caption = "Cholesky's factors of the W × W matrix.",
                                    .x = {},
                                    .y = {},
                                    .series = {}},
                                   &RoundingLoss::normal_equations),
                     excess_figure(losses,
                                   {.name = "orthogonal",
                                    .title = "C by QR in double",
                                    .caption = "Householder's method on the design matrix of cosines and sines.",
                                    .x = {},
                                    .y = {},
                                    .series = {}},
                                   &RoundingLoss::orthogonal),
                     excess_figure(losses,
                                   {.name = "stored-double",
                                    .title = "The optimal C, stored in double",
                                    .caption = "As a polynomial a cell with double coefficients.",
                                    .x = {},
                                    .y = {},
                                    .series = {}},
                                   &RoundingLoss::stored_in_double),
                     excess_figure(losses,
                                   {.name = "stored-single",
                                    .title = "The optimal C, stored in single",
                                    .caption = "Values of C rounded to floats.",
                                    .x = {},
                                    .y = {},
                                    .series = {}},
                                   &RoundingLoss::stored_in_single)};
  return section;
}

}  // namespace misfit::tools
