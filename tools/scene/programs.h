#pragma once

#include <string>
#include <vector>

#include "tools/base/progress.h"
#include "tools/run/image_options.h"
#include "tools/scene/truth.h"

namespace misfit::tools {

/// A whole program that makes the dirty image from the MeasurementSet, as a person calls it.
struct ProgramResult {
  std::string name;                ///< "wsclean, w-gridder to 1e-4"
  std::vector<std::string> words;  ///< as called, but for the folder of its images
  std::vector<double> seconds;     ///< wall clock of each run, by turns with the others; none where it failed
  SceneErrors errors;              ///< NaN where it failed
  std::string failure;             ///< its last words, if it failed

  std::string command() const;
};

struct ProgramComparison {
  std::vector<ProgramResult> results;
  int rounds = 0;
  std::vector<std::string> left_out;  ///< a sentence for each program that was, with the reason
};

/// `misfit image` to two accuracies, and WSClean's gridders where it is installed and can be given the same samples: no
/// selection, and a data column that it takes. Each is run three times, by turns; and once to predict the truth's model into
/// a copy of the set, unless that takes more than 2 GiB. One that fails is not run again. Where it is to be quick each is run
/// once, and none is begun after 40 s. Throws Interrupted.
ProgramComparison run_programs(const ImageOptions& scene, const SceneTruth& truth, int threads, bool quick,
                               ProgressLine& progress);

}  // namespace misfit::tools
