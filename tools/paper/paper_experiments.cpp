#include "tools/paper/paper_experiments.h"

#include <array>
#include <cmath>
#include <functional>

#include "imager/numerics/parallel.h"
#include "kernels/catalogue.h"

namespace misfit::tools {
namespace {

/// A stage of the run.
struct Part {
  const char* stage;
  std::function<PaperExperiment()> make;
};

}  // namespace

std::vector<ReportSection> paper_experiments(SolvedKernels& solved, ProgressLine& progress) {
  progress.begin("the paper's scene");
  const CardScene scene = card_scene({.threads = imager::available_threads()});
  progress.end();
  const std::array<Part, 5> parts{{{"the paper's image misfit", [&] { return image_misfit_experiment(scene, solved); }},
                                   {"the paper's tables", [&] { return table_experiment(scene, solved); }},
                                   {"the paper's aliases", [&] { return aliasing_experiment(solved); }},
                                   {"the paper's degridding", [&] { return degridding_experiment(scene, solved); }},
                                   {"the paper's short table", [&] { return casa_experiment(scene, solved); }}}};
  std::vector<ReportSection> sections;
  std::vector<Statement> statements;
  for (const Part& part : parts) {
    progress.begin(part.stage);
    progress.update(sections.size(), parts.size());
    const PaperExperiment experiment = part.make();
    progress.end();
    sections.push_back(experiment.section);
    statements.insert(statements.end(), experiment.statements.begin(), experiment.statements.end());
  }
  sections.push_back({.heading = "The paper's experiments: what they confirm",
                      .paragraphs = {},
                      .figures = {},
                      .tables = {statements_table("paper-experiments", "What the experiments confirm",
                                                  "Computed by this run. Statements on the functions themselves are in the "
                                                  "first table of this page.",
                                                  statements)}});
  return sections;
}

ComparedKernels compared_kernels(SolvedKernels& solved, int width, double x0) {
  return {store("least-misfit", solved(width, x0)), kernels::kernel_family("spheroidal-exact").make(width, x0)};
}

int fft_size_for(const CardScene& scene, double x0) {
  return 2 * static_cast<int>(std::lround(scene.geometry.width / (4 * x0)));
}

}  // namespace misfit::tools
