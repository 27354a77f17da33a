#include "tools/stability/stability_report.h"

#include <functional>
#include <vector>

namespace misfit::tools {
namespace {

struct Part {
  const char* stage;
  std::function<ReportSection()> make;
};

/// The most samples: sums in extended precision then take about a minute.
constexpr std::size_t most_samples = 30000;

std::vector<Part> parts_of(const StabilityData& data, const StabilityOptions& options) {
  return {{"boundaries of cells", boundaries_section},
          {"large coordinates", coordinates_section},
          {"large and small values", magnitudes_section},
          {"long sums", accumulation_section},
          {"runs: weights and crowds", [&] { return values_section(data, options); }},
          {"runs: uv coverage", [&] { return places_section(data); }},
          {"runs: w", [&] { return w_section(data, options); }},
          {"runs: poles", [&] { return poles_section(data); }}};
}

}  // namespace

Report stability_report(const StabilityOptions& options, ProgressLine& progress) {
  Report report{.title = "Numerical stability",
                .introduction =
                    "What rounding does to least-misfit gridding functions (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146), to "
                    "gridding with them, to long sums and to whole runs of imaging and CLEAN. W is the width in cells, x₀ half "
                    "the fraction of the FFT image that is "
                    "kept, E the mean over |x| ≤ x₀ of the map error ℓ(x), the square of a relative error. Everything here was "
                    "computed when this page was made. Beside each figure and table lies its CSV file.",
                .sections = {}};
  const std::size_t samples = options.quick ? 3000 : most_samples;
  const StabilityData data = options.vis.empty() ? made_data(samples) : sampled_data(options.vis, samples);
  const std::vector<RoundingLoss> losses = rounding_losses(options.quick, progress);
  report.sections.push_back(conditioning_section(losses));
  report.sections.push_back(limits_section(losses));
  for (const Part& part : parts_of(data, options)) {
    progress.begin(part.stage);
    progress.update(0, 1);
    report.sections.push_back(part.make());
    progress.end();
  }
  return report;
}

}  // namespace misfit::tools
