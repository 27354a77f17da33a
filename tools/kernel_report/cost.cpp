#include <algorithm>
#include <array>
#include <cmath>

#include "imager/plan/cost_model.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/kernel_report.h"

namespace misfit::tools {
namespace {

constexpr int image_size = 4096;
constexpr int widest_costed = 12;
constexpr std::array<int, 5> shown_widths{5, 6, 7, 9, 12};

/// A gridding of equal accuracy.
struct Pair {
  int width = 0;
  double x0 = 0;
  double mean_error = 0;
  int degree = 0;
};

Pair pair_of(const kernels::LeastMisfit& solution) {
  return {solution.width, solution.x0, solution.origin.mean_error, store("least-misfit", solution).polynomial.degree()};
}

/// The x0 at which the least-misfit function of `width` has the misfit `wanted`, by bisection: E grows with x0.
Pair pair_like(int width, double wanted) {
  double low = kernels::least_misfit_min_x0;
  double high = kernels::least_misfit_max_x0;
  for (int halving = 0; halving < 14; ++halving) {  // x0 to 3e-5
    const double middle = (low + high) / 2;
    (kernels::solve_least_misfit(width, middle).origin.mean_error < wanted ? low : high) = middle;
  }
  return pair_of(kernels::solve_least_misfit(width, low));
}

std::vector<Pair> pairs_like(const kernels::LeastMisfit& reference) {
  std::vector<Pair> pairs;
  for (int width = shown_widths.front(); width <= widest_costed; ++width)
    pairs.push_back(width == reference.width ? pair_of(reference) : pair_like(width, reference.origin.mean_error));
  return pairs;
}

double fft_size(const Pair& pair) {
  return image_size / (2 * pair.x0);
}

/// W² multiply-adds onto the grid and two polynomials for each of W taps; 5 M log2 M for an FFT of M = N² complex points,
/// half of that for the N² real ones of an image.
double operations(const Pair& pair, double visibilities) {
  const double size = fft_size(pair);
  return visibilities * (pair.width * pair.width + 2.0 * pair.width * (pair.degree + 1)) + 5 * size * size * std::log2(size);
}

double seconds(const Pair& pair, double visibilities) {
  const int size = static_cast<int>(std::lround(fft_size(pair)));
  return imager::CostModel{}.seconds(
      {.samples = visibilities, .width = pair.width, .degree = pair.degree, .nu = size, .nv = size, .columns = image_size});
}

template <typename Cost>
Figure cost_figure(const std::vector<Pair>& pairs, Cost cost) {
  Figure figure{.name = "",
                .title = "",
                .caption = "",
                .x = {.label = "visibilities", .logarithmic = true},
                .y = {.label = "", .logarithmic = true},
                .series = {}};
  std::vector<double> visibilities;
  for (int step = 0; step <= 120; ++step) visibilities.push_back(std::pow(10, 4 + step / 20.0));
  Series least{.label = "least of W = 5…12", .x = visibilities, .y = {}, .law = true};
  for (const double count : visibilities) {
    double lowest = cost(pairs.front(), count);
    for (const Pair& pair : pairs) lowest = std::min(lowest, cost(pair, count));
    least.y.push_back(lowest);
  }
  for (const Pair& pair : pairs) {
    if (std::find(shown_widths.begin(), shown_widths.end(), pair.width) == shown_widths.end()) continue;
    Series series{.label = width_label(pair.width) + ", " + x0_label(pair.x0), .x = visibilities, .y = {}};
    for (const double count : visibilities) series.y.push_back(cost(pair, count));
    figure.series.push_back(series);
  }
  figure.series.push_back(least);
  return figure;
}

DataTable pairs_table(const std::vector<Pair>& pairs) {
  DataTable table{.name = "equal-accuracy",
                  .title = "Pairs of equal accuracy",
                  .caption = "N is the side of the FFT for an image of 4096² pixels.",
                  .columns = {"W", "x₀", "padding", "N", "√E"},
                  .rows = {}};
  for (const Pair& pair : pairs)
    table.rows.push_back(
        {static_cast<double>(pair.width), pair.x0, 1 / (2 * pair.x0), std::round(fft_size(pair)), std::sqrt(pair.mean_error)});
  return table;
}

}  // namespace

ReportSection cost_section(SolvedKernels& solved) {
  const kernels::LeastMisfit& reference = solved(7, 0.25);
  const std::vector<Pair> pairs = pairs_like(reference);
  Figure count = cost_figure(pairs, operations);
  count.name = "cost-operations";
  count.title = "Operations to grid and transform 4096² pixels";
  count.caption =
      "W² + 2W(D + 1) for each visibility, D the degree of the taps' polynomials, and 5 N² log₂N for the FFT of real "
      "images. Few visibilities want little padding and a wide function, many the opposite.";
  count.y.label = "operations";
  Figure time = cost_figure(pairs, seconds);
  time.name = "cost-seconds";
  time.title = "Seconds on one core, by the cost model of this program";
  time.caption = "With the model's fixed constants, for dirty image and PSF in double precision.";
  time.y.label = "seconds";
  return {.heading = "Cost",
          .paragraphs =
              {"The paper's pairs of W and x₀ are under its statements, and differ in accuracy. These all have the misfit "
               "of W = 7 at x₀ = 0.25, √E = " +
               power_of_ten(std::sqrt(reference.origin.mean_error), 3) + ", found by a search over x₀."},
          .figures = {count, time},
          .tables = {pairs_table(pairs)}};
}

}  // namespace misfit::tools
