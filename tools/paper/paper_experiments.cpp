#include "tools/paper/paper_experiments.h"

#include <array>
#include <cmath>
#include <functional>

#include "imager/numerics/parallel.h"
#include "kernels/catalogue.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

/// A stage of the run.
struct Part {
  const char* stage;
  std::function<PaperExperiment()> make;
};

DataTable confirmed_table(std::vector<std::vector<DataTable::Cell>> rows) {
  return {
      .name = "paper-experiments",
      .title = "What the experiments confirm",
      .caption =
          "Computed by this run. What is called the paper's is from its abstract and equations: its Table 1 and the values in "
          "its figures were not at hand. Statements on the functions themselves are in the first table of this page.",
      .columns = {"statement", "the paper", "our numbers", ""},
      .rows = std::move(rows)};
}

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
  std::vector<std::vector<DataTable::Cell>> rows;
  for (const Part& part : parts) {
    progress.begin(part.stage);
    progress.update(sections.size(), parts.size());
    const PaperExperiment experiment = part.make();
    progress.end();
    sections.push_back(experiment.section);
    rows.insert(rows.end(), experiment.statements.begin(), experiment.statements.end());
  }
  sections.push_back({.heading = "The paper's experiments: what they confirm",
                      .paragraphs = {},
                      .figures = {},
                      .tables = {confirmed_table(std::move(rows))}});
  return sections;
}

ComparedKernels compared_kernels(SolvedKernels& solved, int width, double x0) {
  return {store("least-misfit", solved(width, x0)), kernels::kernel_family("spheroidal-exact").make(width, x0)};
}

std::vector<DataTable::Cell> hundredfold_row(const std::string& statement, const std::map<int, double>& ratio_by_width) {
  std::string numbers;
  int first = 0;  // width from which on the ratio is above 100
  for (const auto& [width, ratio] : ratio_by_width) {
    numbers += (numbers.empty() ? "" : ", ") + significant(ratio, 3) + " (" + width_label(width) + ")";
    if (ratio <= 100) {
      first = 0;
    } else if (first == 0) {
      first = width;
    }
  }
  return {statement, "more than 100", numbers,
          first == 0 ? verdict(false, "no width here reaches 100") : "agrees from W = " + std::to_string(first)};
}

std::string verdict(bool agrees, const std::string& why) {
  return agrees ? "agrees" : "differs: " + why;
}

int fft_size_for(const CardScene& scene, double x0) {
  return 2 * static_cast<int>(std::lround(scene.geometry.width / (4 * x0)));
}

}  // namespace misfit::tools
