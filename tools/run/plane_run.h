#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/data/extent.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/streaming/streamed_visibilities.h"
#include "tools/base/progress.h"
#include "tools/run/clean_stage.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"
#include "tools/run/taylor_stage.h"

namespace misfit::tools {

/// What a plane of a run is made with. Planes that are made at the same time have a `progress`, `times` and `warn` each.
struct PlaneScene {
  const ImageOptions& options;
  const imager::ImageGeometry& geometry;
  const std::vector<imager::Stokes>& stokes;
  imager::UvwReach reach;
  int threads = 1;
  ProgressLine& progress;
  imager::StageTimes& times;
  std::function<void(const std::string& sentence)> warn;
  std::function<bool()> given_up = {};  ///< whether the plane is of no use any more: its work then ends in Interrupted

  imager::Context context() const;
};

/// What is done for one plane of frequency, of all Stokes parameters: weights, dirty images and PSF, their errors, beam, CLEAN.
/// The steps are called in the order in which they stand here, and tell in report() what came of them. Stages timed: "weights",
/// "statistics", "verify", "fit beam", and those of the imager's functions.
class PlaneRun {
 public:
  /// Both are kept by reference. `name` follows what messages speak of: " of plane 12"; empty where there is one.
  PlaneRun(const PlaneScene& scene, imager::StreamedVisibilities& source, std::string name);

  /// A pass over the samples where their weights follow from their density.
  void weigh();
  /// The same with weights made before.
  void weigh(std::shared_ptr<const imager::ImagingWeights> weights);
  /// By `transform`, if it is given, which is that of `plan`.
  void make_dirty(imager::GriddingPlan plan, std::shared_ptr<const imager::PlannedTransform> transform = nullptr);
  /// Those of further Taylor terms, which CLEAN then has too. `taylor` is kept by reference.
  void make_terms(TaylorStage& taylor);
  void verify();
  /// For rank 0, which has the PSF.
  void choose_beams();
  /// Makes the parts of residuals that this rank's samples give, while rank 0 is in clean().
  void follow_clean();
  /// One Stokes parameter after the other. Told of the state with which CLEAN of each begins, and after every major cycle.
  void clean(CleanStage& stage, const nlohmann::json& option_values,
             const std::function<void(std::size_t stokes, const imager::CleanState&)>& cycle);

  const PlaneScene& scene() const { return scene_; }
  PlaneReport& report() { return report_; }
  imager::AccurateImages& made() { return made_; }
  std::vector<imager::CleanResult>& cleaned() { return cleaned_; }  ///< [Stokes], or none

 private:
  void predict_noise();
  imager::CleanResult clean(CleanStage& stage, std::size_t stokes, const nlohmann::json& option_values,
                            const imager::CycleProgress& cycle);

  const PlaneScene& scene_;
  imager::StreamedVisibilities& source_;
  std::string name_;
  std::shared_ptr<const imager::ImagingWeights> weights_;  ///< until the noise is predicted; null where they are the data's
  imager::AccurateImages made_;
  TaylorStage* taylor_ = nullptr;  ///< null where there is one term
  std::vector<imager::CleanResult> cleaned_;
  PlaneReport report_;
};

}  // namespace misfit::tools
