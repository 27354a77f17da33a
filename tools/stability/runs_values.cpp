#include <algorithm>
#include <cmath>
#include <string>

#include "imager/numerics/constants.h"
#include "tools/base/numbers.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {
namespace {

StabilityCase equally_weighted(const StabilityData& data, float weight, double scale, const std::string& name) {
  imager::VisibilityBlock block = data.block;
  block.weight.assign(block.samples(), weight);
  StabilityCase made = case_of(name, block, data);
  auto scaled = std::make_shared<imager::VisibilityBlock>(*made.block);
  for (std::complex<float>& v : scaled->visibility) v *= static_cast<float>(scale);
  made.block = scaled;
  made.threshold_jy *= scale;
  return made;
}

Figure error_figure(Figure figure, const std::string& x_label, const std::vector<StabilityOutcome>& outcomes,
                    const std::vector<double>& x) {
  figure.x = {.label = x_label, .logarithmic = true};
  figure.y = {.label = "measured error / accuracy", .logarithmic = true};
  for (const double accuracy : {1e-4, 1e-9}) {
    Series series{.label = "accuracy " + power_of_ten(accuracy, 1), .x = {}, .y = {}, .points = true};
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].accuracy != accuracy) continue;
      series.x.push_back(x[i / 2]);
      series.y.push_back(outcomes[i].measured.rms / accuracy);
    }
    figure.series.push_back(series);
  }
  return figure;
}

constexpr double ranges[] = {1, 1e3, 1e6, 1e9};

Figure depth_figure(const std::vector<StabilityOutcome>& outcomes) {
  Figure figure{.name = "dynamic-range",
                .title = "What CLEAN leaves beside a bright source",
                .caption =
                    "Peak of the residual over that of the dirty image, when CLEAN ended. Visibilities in single precision are "
                    "themselves rounded, by up to 6 × 10⁻⁸.",
                .x = {.label = "brightest source, Jy", .logarithmic = true},
                .y = {.label = "residual / dirty", .logarithmic = true},
                .series = {}};
  for (const double accuracy : {1e-4, 1e-9}) {
    Series series{.label = "accuracy " + power_of_ten(accuracy, 1), .x = {}, .y = {}, .points = true};
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].accuracy != accuracy) continue;
      series.x.push_back(ranges[i / 2]);
      series.y.push_back(outcomes[i].peak_after_jy() / outcomes[i].peak_before_jy());
    }
    figure.series.push_back(series);
  }
  return figure;
}

std::string depth_text(const StabilityData& data, const std::vector<StabilityOutcome>& outcomes) {
  const StabilityOutcome& o = outcomes.back();
  const double range = ranges[std::size(ranges) - 1];
  const double step_jy = range * 0x1p-24, averaged_jy = step_jy / std::sqrt(3.0 * static_cast<double>(data.block.samples()));
  return "Visibilities in single precision hold " + power_of_ten(range, 1) + " Jy to about " + significant(step_jy, 2) +
         " Jy, which so many of them average to " + significant(averaged_jy, 2) +
         " Jy/beam: fainter sources drown in that. At an accuracy of " + power_of_ten(o.accuracy, 1) + " CLEAN leaves " +
         significant(o.peak_after_jy(), 2) + " Jy/beam at the brightest pixel: " + o.clean.stop_reason + ".";
}

std::vector<double> cell_counts(std::uint64_t most) {
  std::vector<double> counts;
  for (double count = 1e3; count <= static_cast<double>(most); count *= 10) counts.push_back(count);
  return counts;
}

}  // namespace

std::vector<StabilityCase> weight_cases(const StabilityData& data) {
  imager::VisibilityBlock spread = data.block;
  const std::size_t n = spread.samples();
  for (std::size_t i = 0; i < n; ++i) {
    const double part = static_cast<double>(i * 7919 % n) / static_cast<double>(n - 1);  // 7919 is prime: shuffled, all of them
    spread.weight[i] = static_cast<float>(std::pow(10.0, 60 * part - 30));
  }
  return {case_of("weights 1e-30 to 1e30", spread, data), equally_weighted(data, 1e30F, 1e9, "weights 1e30, 10⁹ Jy"),
          equally_weighted(data, 1e-30F, 1e-12, "weights 1e-30, 10⁻¹² Jy")};
}

std::vector<StabilityCase> dynamic_range_cases(const StabilityData& data) {
  std::vector<StabilityCase> cases;
  for (const double range : ranges) {
    StabilityCase made = case_of(power_of_ten(range, 1) + " Jy beside 0.3 Jy", data.block, data, range);
    made.max_iterations = 2000;
    cases.push_back(made);
  }
  return cases;
}

std::vector<StabilityCase> one_cell_cases(std::uint64_t most) {
  constexpr double cell_rad = 1e-5;
  const imager::ImageGeometry geometry{stability_pixels, stability_pixels, cell_rad, {}, {}};
  std::vector<StabilityCase> cases;
  for (const double count : cell_counts(most)) {
    const double a_block = std::min(count, std::max(1e4, count / 100));
    imager::VisibilityBlock block;
    block.frequency_hz = {imager::speed_of_light_m_s};
    for (int i = 0; i < a_block; ++i) block.uvw_m.append({0.171 / cell_rad, 0.093 / cell_rad, 0});
    block.weight.assign(block.rows(), 0.3F);
    StabilityCase made = case_of(power_of_ten(count, 1) + " equal samples", block, geometry);
    made.repeats = static_cast<std::uint64_t>(count / a_block);
    made.max_iterations = 20;
    made.max_major_cycles = 1;
    cases.push_back(made);
  }
  return cases;
}

ReportSection values_section(const StabilityData& data, const StabilityOptions& options) {
  const std::uint64_t most = options.quick ? 1000000 : 100000000;
  const auto of_weights = run_cases(weight_cases(data)), of_ranges = run_cases(dynamic_range_cases(data)),
             of_cells = run_cases(one_cell_cases(most));
  return {.heading = "Whole runs: weights, brightness, crowded cells",
          .paragraphs = {"Imaged and cleaned in memory: " + data.description + ", " + std::to_string(stability_pixels) +
                             "² pixels, compared with direct sums in extended precision.",
                         depth_text(data, of_ranges)},
          .figures = {depth_figure(of_ranges),
                      error_figure(
                          {.name = "crowded-cell",
                           .title = "Equal samples in one uv cell",
                           .caption = "Sums in single precision are cut short and go on in double: plain ones would err by "
                                      "3 times the accuracy of 10⁻⁴ at 10⁸ samples.",
                           .x = {},
                           .y = {},
                           .series = {}},
                          "samples", of_cells, cell_counts(most))},
          .tables = {outcome_table("weights", "Weights and values at the ends of single precision", of_weights),
                     outcome_table("bright-sources", "A bright source beside faint ones", of_ranges),
                     outcome_table("crowded-cells", "Equal samples in one uv cell", of_cells)}};
}

}  // namespace misfit::tools
