#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/direct/verify.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/plan/plan.h"
#include "tools/run/beam_choice.h"
#include "tools/run/outside_stage.h"
#include "tools/run/time_forecast.h"
#include "tools/run_page/pixel_histogram.h"

namespace misfit::tools {

/// What a run of `misfit image` has to tell; a part that does not exist is null in report.json.
struct RunReport {
  std::string command_line;
  nlohmann::json options;
  imager::Plan plan;
  std::vector<std::string> warnings;
  double accuracy = 0;  ///< 0 = none was asked
  const imager::GriddingPlan* gridding = nullptr;
  const imager::TheoreticalError* theory = nullptr;
  const imager::MeasuredError* measured = nullptr;
  imager::SampleCounts counts;
  double predicted_noise_jy = 0;  ///< a beam, from the weights; 0 = not known, and so below
  double measured_noise_jy = 0;   ///< of the residual, or of the dirty image where nothing was cleaned
  const BeamChoice* beams = nullptr;
  const imager::CleanReport* clean = nullptr;
  PixelHistogram histogram;  ///< of the residual, or of the dirty image where nothing was cleaned
  const OutsideReport* outside = nullptr;
  double wall_clock_s = 0;
  double estimated_memory_bytes = 0;  ///< at the peak
  const imager::StageTimes* times = nullptr;
  std::vector<StageSeconds> expected;  ///< the same as they were expected, for the cycles and components that there were
};

/// report.json, with the keys of the project's design; `noise` {predicted_jy, measured_jy}, `beam.how`, `beam.misfit`,
/// `beam_by_quadrant`, `memory_gib_estimated`, `warnings`, `command_line`, `outside`, `outside_search`, `timings_s.total`,
/// `timings_expected_s` (by stage, with `total`; null where nothing was expected), `clean.major_cycles_log`, `clean.kept_cycle`
/// (whose model was kept) and `residual_histogram` (see histogram_json()) are additions.
nlohmann::json report_json(const RunReport& report);

}  // namespace misfit::tools
