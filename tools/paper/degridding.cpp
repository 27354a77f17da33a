#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/parallel.h"
#include "kernels/map_error.h"
#include "tools/base/numbers.h"
#include "tools/paper/paper_experiments.h"

namespace misfit::tools {
namespace {

using kernels::Precision;

constexpr int narrowest = 2;
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
double measured_error(const CardScene& scene, const kernels::Kernel& kernel, Precision precision) {
  const int size = fft_size_for(scene, paper_x0);
  const auto transform =
      imager::make_coplanar_transform({scene.geometry, size, size, kernel, kernel, precision, imager::available_threads()});
  const std::vector<std::complex<double>> predicted = transform->predict(model_of(scene))->at(scene.block);
  double difference = 0;
  double norm = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    difference += std::norm(predicted[i] - scene.visibility[i]);
    norm += std::norm(scene.visibility[i]);
  }
  return std::sqrt(difference / norm);
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
  for (int width = narrowest; width <= widest_measured; ++width) {
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
  const auto best_single = std::min_element(series[1].y.begin(), series[1].y.end()) - series[1].y.begin() + narrowest;
  const auto best_twice = std::min_element(series[0].y.begin(), series[0].y.end()) - series[0].y.begin() + narrowest;
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
                   .x = {.label = "width W", .from = narrowest - 0.5, .to = widest_measured + 0.5},
                   .y = {.label = "RMS misfit", .logarithmic = true, .from = 1e-16, .to = 1},
                   .series = series}},
      .tables = {errors_table(series)}};
  constexpr double few_roundings = 200;
  const bool reached = twice < few_roundings * std::numeric_limits<double>::epsilon() &&
                       single < few_roundings * std::numeric_limits<float>::epsilon();
  result.statements = {{"Degridding errors down to machine precision", "can be reached",
                        power_of_ten(single, 2) + " in single (W = " + std::to_string(best_single) + "), " +
                            power_of_ten(twice, 2) + " in double (W = " + std::to_string(best_twice) + ")",
                        verdict(reached, "rounding adds up to more")}};
  return result;
}

}  // namespace misfit::tools
