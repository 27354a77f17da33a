#include "tools/stability_report.h"

#include <array>

namespace misfit::tools {
namespace {

struct Part {
  const char* stage;
  ReportSection (*make)();
};

constexpr std::array<Part, 4> parts{{{"boundaries of cells", boundaries_section},
                                     {"large coordinates", coordinates_section},
                                     {"large and small values", magnitudes_section},
                                     {"long sums", accumulation_section}}};

}  // namespace

Report stability_report(ProgressLine& progress) {
  Report report{
      .title = "Numerical stability",
      .introduction =
          "What rounding does to least-misfit gridding functions (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146), to "
          "gridding with them and to long sums. W is the width in cells, x₀ half the fraction of the FFT image that is "
          "kept, E the mean over |x| ≤ x₀ of the map error ℓ(x), the square of a relative error. Everything here was "
          "computed when this page was made. Beside each figure and table lies its CSV file.",
      .sections = {}};
  const std::vector<RoundingLoss> losses = rounding_losses(progress);
  report.sections.push_back(conditioning_section(losses));
  report.sections.push_back(limits_section(losses));
  for (const Part& part : parts) {
    progress.begin(part.stage);
    progress.update(0, 1);
    report.sections.push_back(part.make());
    progress.end();
  }
  return report;
}

}  // namespace misfit::tools
