#include "tools/kernel_report/kernel_report.h"

#include <array>

#include "tools/paper/paper_experiments.h"

namespace misfit::tools {
namespace {

struct Part {
  const char* stage;
  ReportSection (*make)(SolvedKernels& solved);
};

constexpr std::array<Part, 7> parts{{{"the paper's statements", paper_section},
                                     {"classical functions", classical_section},
                                     {"spheroidal functions", spheroidal_section},
                                     {"least-misfit functions", least_misfit_section},
                                     {"rivals", rivals_section},
                                     {"tables", evaluation_section},
                                     {"cost", cost_section}}};

}  // namespace

Report kernel_report(const KernelReportOptions& options, ProgressLine& progress) {
  Report report{.title = "Gridding functions",
                .introduction =
                    "Least-misfit gridding functions (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146) and others, judged by the "
                    "same map error ℓ(x). W is the width in cells, x₀ half the fraction of the FFT image that is kept, E the "
                    "mean of ℓ over |x| ≤ x₀. Beside each figure and table lies its CSV file; report.json has them all.",
                .sections = {}};
  SolvedKernels solved;
  for (const Part& part : parts) {
    if (options.quick && part.make == rivals_section) continue;
    progress.begin(part.stage);
    progress.update(report.sections.size(), parts.size());
    report.sections.push_back(part.make(solved));
    progress.end();
  }
  if (options.paper)
    for (const ReportSection& section : paper_experiments(solved, progress)) report.sections.push_back(section);
  return report;
}

}  // namespace misfit::tools
