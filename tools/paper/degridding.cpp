#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "kernels/evaluation.h"
#include "kernels/map_error.h"
#include "tools/base/numbers.h"
#include "tools/paper/paper_experiments.h"
#include "tools/paper/plain_gridder.h"

namespace misfit::tools {
namespace {

using kernels::Precision;

constexpr int narrowest_predicted = 2;
constexpr int widest_measured = 16;

/// The sources as an image.
imager::Image model_of(const CardScene& scene) {
  imager::Image model(scene.geometry.width, scene.geometry.height);
  for (const imager::Source& source : scene.sources) {
    const auto column = scene.geometry.centre_column() - std::lround(source.position.l / scene.geometry.cell_rad);
    const auto row = scene.geometry.centre_row() + std::lround(source.position.m / scene.geometry.cell_rad);
    model.at(static_cast<int>(row), static_cast<int>(column)) += source.flux_jy;
  }
  return model;
}

/// ‖predicted − direct‖ / ‖direct‖.
double relative_error(const CardScene& scene, const std::vector<std::complex<double>>& predicted) {
  double difference = 0;
  double norm = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    difference += std::norm(predicted[i] - scene.visibility[i]);
    norm += std::norm(scene.visibility[i]);
  }
  return std::sqrt(difference / norm);
}

double measured_error(const CardScene& scene, const kernels::Kernel& kernel, Precision precision) {
  const int size = fft_size_for(scene, paper_x0);
  const auto transform =
      imager::make_coplanar_transform({scene.geometry, size, size, kernel, kernel, precision, imager::available_threads()});
  return relative_error(scene, transform->predict(model_of(scene))->at(scene.block));
}

/// √(Σ S² (ℓ(x) + ℓ(y)) / Σ S²) over the sources: each errs by its own map errors, in directions that do not correlate.
double expected_error(const CardScene& scene, const kernels::Kernel& kernel) {
  const double per_rad = 1 / (scene.geometry.cell_rad * fft_size_for(scene, paper_x0));
  double error = 0;
  double norm = 0;
  for (const imager::Source& source : scene.sources) {
    const Eigen::Vector2d place(source.position.l * per_rad, source.position.m * per_rad);
    const double square = source.flux_jy * source.flux_jy;
    error += square * kernels::map_error(kernel.polynomial, place).sum();
    norm += square;
  }
  return std::sqrt(error / norm);
}

/// The paper's Table 1: degridding with the nearest of Ms entries a cell, W = 7.
struct TableRow {
  int samples;
  double stated;
};
constexpr std::array<TableRow, 5> table_1{
    {{100, 6.23e-3}, {1000, 4.48e-4}, {10000, 4.40e-5}, {100000, 4.62e-6}, {1000000, 4.85e-7}}};
constexpr double stated_without_table = 2.98e-7;
constexpr int table_1_width = 7;

/// √(e² + (2π/Ms)²/12 · Σ S² (x² + y²) / Σ S²): e of the function, and positions off by up to half an entry.
double expected_of_table(const CardScene& scene, double function_error, int samples) {
  const double per_rad = 1 / (scene.geometry.cell_rad * fft_size_for(scene, paper_x0));
  double moment = 0;
  double norm = 0;
  for (const imager::Source& source : scene.sources) {
    const double square = source.flux_jy * source.flux_jy;
    moment += square * std::pow(per_rad, 2) * (std::pow(source.position.l, 2) + std::pow(source.position.m, 2));
    norm += square;
  }
  return std::hypot(function_error, 2 * imager::pi / samples * std::sqrt(moment / norm / 12));
}

struct TableOne {
  DataTable table;
  std::vector<Statement> statements;
};

TableOne compared_table_1(const CardScene& scene, const kernels::Kernel& kernel) {
  const int size = fft_size_for(scene, paper_x0);
  const imager::Image model = model_of(scene);
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, pixel_offsets(scene.geometry.width, size));
  const double function_error = expected_error(scene, kernel);
  TableOne result{{.name = "paper-table-1",
                   .title = "The paper's Table 1: degridding with the nearest of Ms entries a cell, W = 7, x₀ = 0.25",
                   .caption = "RMS misfit of the visibilities of the 34 sources, relative to their RMS.",
                   .columns = {"Ms", "the paper", "our numbers", "theory", "the paper / ours"},
                   .rows = {}},
                  {}};
  std::vector<double> ratios;
  const auto add = [&](double samples, double stated, double ours, double theory) {
    ratios.push_back(stated / ours);
    result.table.rows.push_back({samples, stated, ours, theory, ratios.back()});
  };
  for (const auto& [samples, stated] : table_1) {
    const kernels::Evaluation way =
        kernels::evaluate_by_table(kernel.polynomial, {samples, kernels::Interpolation::nearest}, Precision::double_precision);
    const double ours = relative_error(scene, plain_prediction({scene.geometry, size, way.taps, h}, model, scene.block));
    add(samples, stated, ours, expected_of_table(scene, function_error, samples));
  }
  add(std::nan(""), stated_without_table, measured_error(scene, kernel, Precision::double_precision), function_error);
  const auto [least, most] = std::minmax_element(ratios.begin() + 1, ratios.end() - 1);
  const double law = std::sqrt(std::pow(expected_of_table(scene, function_error, 1000000), 2) - std::pow(function_error, 2));
  const double left = std::sqrt(std::max(0.0, std::pow(table_1.back().stated, 2) - std::pow(law, 2)));
  result.statements = {
      {"Table 1", "Degridding with the nearest of Ms = 10² entries, W = 7", power_of_ten(table_1.front().stated, 3),
       "the paper's is " + significant(ratios.front(), 3) + " times ours",
       verdict(std::abs(ratios.front() - 1) < 0.1, "ours follows the law of nearest entries")},
      {"Table 1", "The same with Ms = 10³ … 10⁶",
       power_of_ten(table_1[1].stated, 3) + " … " + power_of_ten(table_1.back().stated, 3),
       "the paper's are " + significant(*least, 3) + " to " + significant(*most, 3) + " times ours",
       verdict(*least > 0.9 && *most < 1.1, "not by one factor")},
      {"Table 1", "The same without a table", power_of_ten(stated_without_table, 3),
       "the paper's is " + significant(ratios.back(), 3) + " times ours; its number for 10⁶ leaves " + power_of_ten(left, 2) +
           " to the function, " + significant(left / function_error, 2) + " times ours",
       verdict(std::abs(ratios.back() - 1) < 0.1, "the paper's numbers differ from each other, too")}};
  return result;
}

/// One curve and column.
struct Way {
  const char* label;
  kernels::Kernel ComparedKernels::*kernel;
  Precision precision;
};
const std::array<Way, 4> ways{{{"least-misfit, double", &ComparedKernels::least_misfit, Precision::double_precision},
                               {"least-misfit, single", &ComparedKernels::least_misfit, Precision::single_precision},
                               {"spheroidal, double", &ComparedKernels::spheroidal, Precision::double_precision},
                               {"spheroidal, single", &ComparedKernels::spheroidal, Precision::single_precision}}};

std::vector<Series> empty_series() {
  std::vector<Series> series;
  for (const Way& way : ways) series.push_back({.label = way.label, .x = {}, .y = {}, .points = true});
  series.push_back({.label = "theory, least-misfit", .x = {}, .y = {}, .law = true});
  series.push_back({.label = "theory, spheroidal", .x = {}, .y = {}, .law = true});
  return series;
}

std::vector<Series> errors_by_width(const CardScene& scene, SolvedKernels& solved) {
  std::vector<Series> series = empty_series();
  for (int width = narrowest_predicted; width <= widest_measured; ++width) {
    const ComparedKernels pair = compared_kernels(solved, width, paper_x0);
    for (std::size_t k = 0; k < ways.size(); ++k)
      series[k].y.push_back(measured_error(scene, pair.*ways[k].kernel, ways[k].precision));
    series[ways.size()].y.push_back(expected_error(scene, pair.least_misfit));
    series[ways.size() + 1].y.push_back(expected_error(scene, pair.spheroidal));
    for (Series& one : series) one.x.push_back(width);
  }
  return series;
}

DataTable errors_table(const std::vector<Series>& series) {
  DataTable table{.name = "paper-degridding-rms",
                  .title = "The same in numbers",
                  .caption = "‖predicted − direct‖ / ‖direct‖ over all visibilities.",
                  .columns = {"W"},
                  .rows = {}};
  for (const Series& one : series) table.columns.push_back(one.label);
  for (std::size_t i = 0; i < series[0].x.size(); ++i) {
    table.rows.push_back({series[0].x[i]});
    for (const Series& one : series) table.rows.back().emplace_back(one.y[i]);
  }
  return table;
}

}  // namespace

PaperExperiment degridding_experiment(const CardScene& scene, SolvedKernels& solved) {
  const std::vector<Series> series = errors_by_width(scene, solved);
  const double twice = *std::min_element(series[0].y.begin(), series[0].y.end());
  const double single = *std::min_element(series[1].y.begin(), series[1].y.end());
  const auto best_single = std::min_element(series[1].y.begin(), series[1].y.end()) - series[1].y.begin() + narrowest_predicted;
  const auto best_twice = std::min_element(series[0].y.begin(), series[0].y.end()) - series[0].y.begin() + narrowest_predicted;
  const TableOne one = compared_table_1(scene, store("least-misfit", solved(table_1_width, paper_x0)));
  PaperExperiment result;
  result.section = {
      .heading = "The paper's experiments: degridding",
      .paragraphs =
          {"The visibilities of the 34 sources, which are pixels here, predicted by FFT and degridding, against their "
           "sums. Single precision is that of taps, grid and FFT; coordinates are always double. In single precision "
           "wider functions err more again, since h amplifies what is rounded."},
      .figures = {{.name = "paper-degridding",
                   .title = "Misfit of predicted visibilities by width, x₀ = 0.25",
                   .caption =
                       "Broken: √(Σ S² (ℓ(x) + ℓ(y)) / Σ S²) over the sources, of fluxes S. Curves leave it where rounding "
                       "takes over.",
                   .x = {.label = "width W", .from = narrowest_predicted - 0.5, .to = widest_measured + 0.5},
                   .y = {.label = "RMS misfit", .logarithmic = true, .from = 1e-16, .to = 1},
                   .series = series}},
      .tables = {errors_table(series), one.table}};
  constexpr double few_roundings = 200;
  const bool reached = twice < few_roundings * std::numeric_limits<double>::epsilon() &&
                       single < few_roundings * std::numeric_limits<float>::epsilon();
  const auto at = [&](std::size_t way, int width) {
    return series[way].y[static_cast<std::size_t>(width - narrowest_predicted)];
  };
  const double gain = at(1, 7) / single;
  const double spheroidal = at(3, 7) / at(1, 7);
  const std::vector<Statement> others{{"§5", "Degridding in single precision: what more than W = 7 gains", "nothing",
                                       significant(gain, 3) + " times at best, with W = " + std::to_string(best_single),
                                       verdict(gain < 2, "wider functions gain")},
                                      {"§5", "Degridding in single precision, W = 7: spheroidal over least-misfit", "100 times",
                                       significant(spheroidal, 3) + " times", verdict(spheroidal > 100, "less")},
                                      {"Abstract", "Degridding errors down to machine precision", "can be reached",
                                       power_of_ten(single, 2) + " in single (W = " + std::to_string(best_single) + "), " +
                                           power_of_ten(twice, 2) + " in double (W = " + std::to_string(best_twice) + ")",
                                       verdict(reached, "rounding adds up to more")}};
  result.statements = one.statements;
  result.statements.insert(result.statements.end(), others.begin(), others.end());
  return result;
}

}  // namespace misfit::tools
