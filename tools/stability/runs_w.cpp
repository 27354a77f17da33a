#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "imager/data/extent.h"
#include "imager/numerics/constants.h"
#include "imager/plan/gridding_choice.h"
#include "tools/base/numbers.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {
namespace {

/// An image far from the phase centre, where n − 1 is large but hardly bends over the image: few planes, and long phases.
imager::ImageGeometry far_field(const StabilityData& data) {
  return {stability_pixels, stability_pixels, data.cell_rad(), {}, {0.3, -0.2}};
}

std::vector<double> decades(double most_w) {
  std::vector<double> all{0};
  for (double w = 1e4; w <= most_w; w *= 10) all.push_back(w);
  return all;
}

/// The largest turns of u and v, in a field off the phase centre.
double offset_turns(const imager::ImageGeometry& geometry) {
  return (std::abs(geometry.centre.l) + std::abs(geometry.centre.m)) / (2 * geometry.cell_rad);
}

double turns(double w, const imager::ImageGeometry& geometry) {
  return w * imager::largest_drop(geometry) + offset_turns(geometry);
}

/// The |w| whose phases are rounded by the accuracy; 0 where phases of u and v are.
double last_w(double accuracy, const imager::ImageGeometry& geometry) {
  const double rounding_a_turn = imager::phase_rounding(1) - imager::phase_rounding(0);
  return std::max(0.0, accuracy / rounding_a_turn - offset_turns(geometry)) / imager::largest_drop(geometry);
}

Figure w_figure(const std::vector<StabilityOutcome>& outcomes, const std::vector<double>& reach,
                const imager::ImageGeometry& geometry) {
  Figure figure{.name = "long-phases",
                .title = "Error against |w|",
                .caption =
                    "Of images gridded with a w axis, compared with direct sums in extended precision. The law is the "
                    "rounding of phases of double precision, 2π turns × 1.1 × 10⁻¹⁶.",
                .x = {.label = "largest |w|, wavelengths", .logarithmic = true},
                .y = {.label = "measured error", .logarithmic = true},
                .series = {}};
  Series law{.label = "rounding of phases", .x = {}, .y = {}, .law = true};
  for (const double accuracy : {1e-4, 1e-9}) {
    Series series{.label = "accuracy " + power_of_ten(accuracy, 1), .x = {}, .y = {}, .points = true};
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].accuracy != accuracy) continue;
      series.x.push_back(reach[i / 2]);
      series.y.push_back(outcomes[i].measured.rms);
    }
    figure.series.push_back(series);
  }
  for (const double w : reach) {
    law.x.push_back(w);
    law.y.push_back(imager::phase_rounding(turns(w, geometry)));
  }
  figure.series.push_back(law);
  return figure;
}

}  // namespace

std::vector<StabilityCase> w_cases(const StabilityData& data, const std::vector<double>& reaches) {
  const imager::ImageGeometry geometry = far_field(data);
  std::vector<StabilityCase> cases;
  for (const double reach : reaches) {
    imager::VisibilityBlock block = data.block;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::size_t row = 0; row < block.rows(); ++row) block.uvw_m.edit()[3 * row + 2] = reach * uniform(random);
    cases.push_back(case_of("|w| to " + power_of_ten(reach, 1), block, geometry));
  }
  return cases;
}

ReportSection w_section(const StabilityData& data, const StabilityOptions& options) {
  const imager::ImageGeometry geometry = far_field(data);
  const std::vector<double> reach = decades(options.quick ? 1e11 : 1e13);
  const auto outcomes = run_cases(w_cases(data, reach));
  const std::string ends =
      "Phases of double precision are rounded by 2π |w| (1 − n) × 1.1 × 10⁻¹⁶, which no kernel mends. At 1 − n = " +
      significant(imager::largest_drop(geometry), 2) +
      ", that of this field, an accuracy of 10⁻⁹ ends at |w| = " + power_of_ten(last_w(1e-9, geometry), 2) +
      " wavelengths, one of 10⁻⁴ at " + power_of_ten(last_w(1e-4, geometry), 2) + "; u and v have phases of " +
      power_of_ten(offset_turns(geometry), 2) +
      " turns themselves, so far from the phase centre. Beyond that the plan refuses, and says what can be reached.";
  return {.heading = "Whole runs: w until phases lose their digits",
          .paragraphs = {ends},
          .figures = {w_figure(outcomes, reach, geometry)},
          .tables = {outcome_table("large-w", "Images with w", outcomes)}};
}

}  // namespace misfit::tools
