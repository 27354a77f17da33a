#pragma once

#include <memory>

#include "imager/numerics/spares.h"
#include "tools/run/channel_batches.h"
#include "tools/run/channel_run.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {

/// The means to make the channels of a run. References must outlive it.
struct ChannelMeans {
  const imager::GriddingPlan& plan;
  std::shared_ptr<const imager::PlannedTransform> transform;  ///< of `plan`; null where there is one channel, which makes it
  ChannelWorkers workers;
  bool images_here = true;                   ///< or at rank 0 alone, which cleans and writes them
  PrimaryBeamStage* primary_beam = nullptr;  ///< null where neither images nor masks need it
};

/// Makes the channels of a run: as many at a time as there are workers, in any order, each in a thread of its own. The result
/// of a channel does not depend on other channels.
class ChannelMaker {
 public:
  /// `clean` is the first worker's, null where nothing is cleaned here; the other workers' stages are made like it.
  ChannelMaker(const ChannelScene& scene, ChannelMeans means, std::unique_ptr<CleanStage> clean);

  /// From here on channels have these weights, and not weights that follow from their own samples.
  void weigh_by(std::shared_ptr<const imager::ImagingWeights> weights) { common_weights_ = std::move(weights); }

  /// Weighs and images the samples of a channel. A channel without samples, null, has no values and no beam; nor has one whose
  /// samples all lie beyond the grid, unless it is the only one: then throws NothingUsable or NothingInGrid.
  std::unique_ptr<ChannelRun> image(int channel, std::unique_ptr<ChannelSamples> samples);
  /// All else before CLEAN: Taylor terms, measured errors, beams. Nothing where there are no values.
  void prepare_clean(ChannelRun& run);
  /// CLEAN, where it is wanted and there is a beam. Throws Interrupted where others gave up.
  void clean(ChannelRun& run);

 private:
  const ChannelScene& scene_;
  ChannelMeans means_;
  std::shared_ptr<const imager::ImagingWeights> common_weights_;  ///< null where each channel has its own
  imager::Spares<CleanStage> cleans_;                             ///< one for each worker
};

}  // namespace misfit::tools
