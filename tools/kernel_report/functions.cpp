#include <array>
#include <cmath>

#include "kernels/catalogue.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/kernel_report.h"

namespace misfit::tools {
namespace {

using kernels::Kernel;
using kernels::TapFunction;

struct ClassicalFunction {
  const char* family;
  const char* label;
  int width;
};

/// The functions that the paper compares with, in its authors' widths.
constexpr std::array<ClassicalFunction, 5> classical{{{"nearest", "nearest cell", 1},
                                                      {"linear", "linear", 2},
                                                      {"sinc", "sinc", 8},
                                                      {"gaussian", "Gaussian", 8},
                                                      {"gaussian-sinc", "Gaussian × sinc", 8}}};

DataTable::Cell number_cell(double value) {
  return value;
}

Figure corrections_of(const TapFunction& taps) {
  Figure figure{.name = "spheroidal-6-corrections",
                .title = "Two corrections of the spheroidal function, W = 6",
                .caption =
                    "The optimal h and 1/c, the reciprocal of the taper, part only towards the image's edge, where the "
                    "optimal one gives up on what the aliases have spoilt.",
                .x = {.label = "x, offset from the phase centre / size of the FFT", .from = 0, .to = 0.5},
                .y = {.label = "correction, 1 at x = 0", .logarithmic = true},
                .series = {}};
  const Eigen::VectorXd x = places(0.5);
  const Eigen::VectorXd h = kernels::optimal_correction(taps, x);
  const Eigen::VectorXd reciprocal = kernels::image_taper(taps, x).cwiseInverse();
  figure.series = {curve("optimal h", x, h / h[0]), curve("1/c", x, reciprocal / reciprocal[0])};
  return figure;
}

/// ℓ(x) with either correction, and how far, relatively, the one with 1/c is from ℓ/(1−ℓ), where ℓ is not rounding alone.
struct CorrectionErrors {
  Figure figure;
  double from_law = 0;
};
CorrectionErrors correction_errors_of(const TapFunction& taps) {
  CorrectionErrors result{map_error_figure("spheroidal-6-map-error", "Map error of the spheroidal function, W = 6", 1e-10, 10)};
  const auto reciprocal = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return kernels::image_taper(taps, x).cwiseInverse();
  };
  const Series optimal = map_error_curve("optimal h", taps);
  const Series usual = map_error_curve("1/c", taps, {.correction = reciprocal});
  for (std::size_t k = 0; k < optimal.y.size(); ++k)
    result.from_law = std::max(result.from_law, std::abs(usual.y[k] * (1 - optimal.y[k]) / optimal.y[k] - 1));
  result.figure.caption = "With 1/c the error is ℓ/(1 − ℓ), where ℓ is that with the optimal h: the same until ℓ nears 1.";
  result.figure.series = {optimal, usual};
  return result;
}

/// A figure of C(u) or h(x) for W = 1…10.
template <typename Curve>
void add_widths(Figure& figure, SolvedKernels& solved, Curve curve_of) {
  for (int width = 1; width <= 10; ++width) figure.series.push_back(curve_of(width_label(width), solved(width, paper_x0).taps));
}

Figure functions_figure(SolvedKernels& solved) {
  Figure figure{.name = "least-misfit-functions",
                .title = "Least-misfit functions C(u) at x₀ = 0.25",
                .caption =
                    "Scaled so that h(0) = 1. C jumps where cells meet: at whole u for even W, at half ones for odd W. The "
                    "jumps shrink as W grows.",
                .x = {.label = "u, cells", .from = 0},
                .y = {.label = "C(u)"},
                .series = {}};
  add_widths(figure, solved, function_curve);
  return figure;
}

Figure least_misfit_corrections_figure(SolvedKernels& solved) {
  Figure figure{
      .name = "least-misfit-corrections",
      .title = "Their corrections h(x)",
      .caption = "What the image is multiplied by: the wider C, the narrower its taper, the more h rises to the edge.",
      .x = {.label = "x, offset from the phase centre / size of the FFT", .from = 0, .to = paper_x0},
      .y = {.label = "h(x)"},
      .series = {}};
  add_widths(figure, solved,
             [](const std::string& label, const TapFunction& taps) { return correction_curve(label, taps, paper_x0); });
  return figure;
}

}  // namespace

ReportSection classical_section(SolvedKernels& solved) {
  Figure figure = map_error_figure("classical-functions", "Map error of five classical functions", 1e-10, 1);
  figure.caption = "With the correction that is optimal for each; sinc, Gaussian and their product are cut off at 4 cells.";
  DataTable table{.name = "classical-functions-rms",
                  .title = "The same in numbers",
                  .caption =
                      "RMS error √E over |x| ≤ 0.25, largest ℓ there, and √E as a multiple of that of the least-misfit "
                      "function as wide.",
                  .columns = {"function", "W", "√E", "max ℓ", "× least-misfit"},
                  .rows = {}};
  for (const auto& [family, label, width] : classical) {
    const Kernel kernel = kernels::kernel_family(family).make(width, paper_x0);
    figure.series.push_back(map_error_curve(label, kernel.polynomial));
    const double rms = std::sqrt(kernel.misfit.mean);
    table.rows.push_back(
        {label, number_cell(width), rms, kernel.misfit.max, rms / std::sqrt(solved(width, paper_x0).origin.mean_error)});
  }
  return {.heading = "Classical functions",
          .paragraphs = {"ℓ(x) is the squared relative error of a one-dimensional transform at x, averaged over where "
                         "visibilities fall in their cells; two axes add theirs."},
          .figures = {figure},
          .tables = {table}};
}

ReportSection spheroidal_section(SolvedKernels& /*solved*/) {
  Figure figure = map_error_figure("spheroidal-functions", "Map error of spheroidal functions", 1e-21, 1);
  figure.caption = "(1 − η²) ψ(η), order α = 1, c = πW/2, computed exactly, with the optimal correction.";
  const kernels::KernelFamily family = kernels::kernel_family("spheroidal-exact");
  for (int width = 6; width <= 14; ++width)
    figure.series.push_back(map_error_curve(width_label(width), family.make(width, paper_x0).polynomial));
  const TapFunction six = family.make(6, paper_x0).polynomial;
  const CorrectionErrors errors = correction_errors_of(six);
  return {.heading = "Spheroidal functions",
          .paragraphs = {"Computed directly, the error with 1/c is ℓ/(1 − ℓ) to " + power_of_ten(errors.from_law, 1) +
                         " of itself at every x."},
          .figures = {figure, errors.figure, corrections_of(six)},
          .tables = {}};
}

ReportSection least_misfit_section(SolvedKernels& solved) {
  Figure by_x0 = map_error_figure("least-misfit-by-x0", "Map error of least-misfit functions of W = 8", 1e-28, 1);
  by_x0.caption = "Each is made for |x| ≤ x₀, and pays beyond: the less of the FFT is kept, the smaller the error there.";
  for (const double kept : {0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45})
    by_x0.series.push_back(map_error_curve(x0_label(kept), solved(8, kept).taps));
  Figure by_width = map_error_figure("least-misfit-by-width", "Map error of least-misfit functions at x₀ = 0.25", 1e-32, 1);
  by_width.caption =
      "Taps solved for every position, then rounded to doubles. A width more divides ℓ by about 100 where |x| ≤ x₀.";
  for (int width = 6; width <= 14; ++width)
    by_width.series.push_back(map_error_curve(width_label(width), solved(width, paper_x0).taps));
  return {.heading = "Least-misfit functions",
          .paragraphs = {"C and h together make E, the mean of ℓ over |x| ≤ x₀, as small as it can be."},
          .figures = {by_x0, by_width, functions_figure(solved), least_misfit_corrections_figure(solved)},
          .tables = {}};
}

}  // namespace misfit::tools
