#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/numerics/spares.h"
#include "tools/run/cube_batches.h"
#include "tools/run/cube_products.h"
#include "tools/run/plane_run.h"

namespace misfit::tools {

/// What came of a plane of a cube, for the run that puts the planes together.
struct CubePlane {
  PlaneReport report;
  std::uint64_t outside_grid = 0;     ///< samples
  double components = 0;              ///< of CLEAN
  double major_cycles = 0;            ///< that predicted and subtracted
  std::vector<std::string> warnings;  ///< in their order
  std::vector<std::string> doubts;    ///< what may be so of several planes, in the same words
  imager::StageTimes times;

  bool empty() const { return report.sums.used == 0; }
  /// Whether the user ended its CLEAN.
  bool stopped() const;
};

/// What the planes of a cube share. References must outlive who has it.
struct CubeScene {
  const ImageOptions& options;
  const nlohmann::json& option_values;
  const imager::ImageHeader& header;
  imager::UvwReach reach;
  const imager::GriddingPlan& plan;
  std::shared_ptr<const imager::PlannedTransform> transform;  ///< of `plan`
  PlaneWorkers workers;
  const PrimaryBeamStage* primary_beam = nullptr;  ///< null where none is wanted
  CubeFiles::Open open;
};

/// Makes the planes of a cube and writes their images: as many at a time as there are workers, in any order, each in a thread
/// of its own. What comes of a plane does not depend on the others. Stages timed, by each plane for itself: those of PlaneRun,
/// of CLEAN, and of CubeProducts.
class CubePlanes {
 public:
  /// Opens what CLEAN begins with, and begins the files.
  explicit CubePlanes(CubeScene scene);

  /// From here on planes have these weights, and not such that follow from their own samples.
  void weigh_by(std::shared_ptr<const imager::ImagingWeights> weights) { common_weights_ = std::move(weights); }

  /// Throws Interrupted where the user wants to stop, or after give_up(); a plane in CLEAN stops after its major cycle.
  CubePlane make(int channel, imager::StreamedVisibilities& visibilities);
  /// One without samples, which has no values and no beam.
  CubePlane empty(int channel) const;
  /// Those that are being made are of no use any more.
  void give_up() { given_up_ = true; }

  CubeProducts& products() { return products_; }

 private:
  void make(PlaneRun& run, CubePlane& plane);
  void clean(PlaneRun& run, CubePlane& plane);

  CubeScene scene_;
  std::shared_ptr<const imager::ImagingWeights> common_weights_;  ///< null where each plane has its own
  CubeProducts products_;
  imager::Spares<CleanStage> cleans_;  ///< one for each worker
  std::atomic<bool> given_up_ = false;
};

}  // namespace misfit::tools
