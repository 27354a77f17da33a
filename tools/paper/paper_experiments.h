#pragma once

#include <string>
#include <vector>

#include "kernels/kernel.h"
#include "tools/base/progress.h"
#include "tools/paper/card_scene.h"
#include "tools/paper/statement.h"
#include "tools/report/kernel_curves.h"
#include "tools/report/report_folder.h"

namespace misfit::tools {

/// The experiments of Ye, Gull, Tan & Nikolic 2020 (MNRAS 491, 1146) made again: images and visibilities computed by gridding,
/// against direct sums. A section for each, and last what they confirm. Throws Interrupted.
std::vector<ReportSection> paper_experiments(SolvedKernels& solved, ProgressLine& progress);

/// An experiment: what to show, and what it says of the paper's statements.
struct PaperExperiment {
  ReportSection section;
  std::vector<Statement> statements;
};

/// Each in a file of its own. All images are of the scene's size.
PaperExperiment image_misfit_experiment(const CardScene& scene, SolvedKernels& solved);  ///< misfit against x by width
PaperExperiment table_experiment(const CardScene& scene, SolvedKernels& solved);         ///< misfit with tables, by Ms
PaperExperiment aliasing_experiment(SolvedKernels& solved);                              ///< sources outside the field
PaperExperiment degridding_experiment(const CardScene& scene, SolvedKernels& solved);    ///< predicted visibilities
PaperExperiment casa_experiment(const CardScene& scene, SolvedKernels& solved);          ///< a short table against CASA's

/// The two functions that the paper compares.
struct ComparedKernels {
  kernels::Kernel least_misfit;
  kernels::Kernel spheroidal;  ///< α = 1, computed exactly
};
ComparedKernels compared_kernels(SolvedKernels& solved, int width, double x0);

/// The size of the FFT whose part 2·x0 is the scene's image, rounded to even.
int fft_size_for(const CardScene& scene, double x0);

}  // namespace misfit::tools
