#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/outside/wide_search.h"
#include "imager/plan/gridding_plan.h"
#include "imager/plan/memory_use.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/base/progress.h"
#include "tools/run/image_options.h"
#include "tools/run/time_forecast.h"

namespace misfit::tools {

/// The input of a run's plan.
struct RunScene {
  const ImageOptions& options;
  const ms_io::MeasurementSet& set;
  const imager::Ranks& ranks;  ///< that take part in the run
  imager::ImageGeometry geometry;
  ms_io::SetReach reach;
  int threads = 1;
  bool mask = false;                                         ///< there is or will be one, where components may lie
  const TakenFiles* taken = nullptr;                         ///< null where all images are made
  std::shared_ptr<const imager::MosaicRequest> mosaic = {};  ///< null where no mosaic is made
  int channels = 1;                                          ///< of the image
  int workers = 1;      ///< channels made at a time, where memory allows; they share the threads
  double samples = 0;   ///< of a channel at most, in Stokes samples of all ranks: gridding is chosen by them, whoever does it
  double share = 1;     ///< the part of `samples` that this rank has
  double enlarged = 1;  ///< samples and rows over those of `set`, where others are planned for; `samples` is of these
};

/// The decisions of `misfit image` before it reads a visibility. The stages that follow obey it and do not change it.
struct RunPlan {
  imager::GriddingPlan gridding;
  std::unique_ptr<imager::GriddingPlan> wider;  ///< of the field to search for sources outside; null without
  imager::WideField wide_field;                 ///< the field of `wider`
  imager::StreamingOptions streaming;
  imager::MemoryUse memory;             ///< at its peak
  std::vector<StageSeconds> spent;      ///< on the stages up to here
  imager::Plan decisions;               ///< but for those of `gridding`
  std::vector<std::string> warnings{};  ///< what the user should know before the run goes on
  std::string scale{};                  ///< the text of ScaleForecast for --nodes; empty without
};

/// Plans the gridding, the search for sources outside, and the memory. Says on `progress` how an option is understood. Stages
/// timed: "plan". Throws what plan_gridding and plan_memory do.
RunPlan plan_run(const RunScene& scene, imager::StageTimes& times, ProgressLine& progress);

/// Adds to the plan the time that it will take, besides `times` of the stages before; for CLEAN, whose cycles nobody knows
/// beforehand, the time of one cycle; and what --nodes asks for. `work` is the work of the plan.
void foretell(const RunScene& scene, const TimeForecast& forecast, const RunWork& work, const imager::StageTimes& times,
              RunPlan& plan);

/// The components that a major cycle is expected to find.
int components_of_a_cycle(const ImageOptions& options);

/// The work of the planned run, without CLEAN. Points into `plan`.
RunWork work_of(const RunScene& scene, const RunPlan& plan);

/// The seconds of all stages: `plan.spent`, and the seconds expected of `work`.
std::vector<StageSeconds> expected_seconds(const RunPlan& plan, const TimeForecast& forecast, const RunWork& work);

/// Every decision, the seconds expected and the memory, a line each; and what --nodes asks for.
std::string plan_text(const RunPlan& plan, const std::vector<StageSeconds>& expected);

}  // namespace misfit::tools
