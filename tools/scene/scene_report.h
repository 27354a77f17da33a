#pragma once

#include <string>
#include <vector>

#include "tools/base/progress.h"
#include "tools/report/report_folder.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

struct SceneReportOptions {
  ImageOptions scene;
  std::vector<std::string> kernels;  ///< besides those of the catalogue: names or files
  bool quick = false;                ///< fewer points, each run fewer times, and those left out that do not fit in
  double seconds = 0;                ///< for the runs of all points; 0 = 75 where it is to be quick, else 600
  std::string results_file;          ///< kept while it is made, so that a run that was stopped goes on from it
};

/// Error against run time for one scene: every kernel at many widths, paddings and evaluations, measured against the direct
/// transform, with what theory said; and whole programs. Throws Interrupted, with what was measured kept.
Report scene_report(const SceneReportOptions& options, ProgressLine& progress);

}  // namespace misfit::tools
