#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "tools/run/cube_planes.h"
#include "tools/run/cube_visibilities.h"
#include "tools/run/shared_cube.h"

namespace misfit::tools {

/// Who makes which planes of a cube: ranks take batches in turns, and rank 0 gets what comes of all. It is all the same where
/// there is one rank.
class CubeTurns {
 public:
  /// `ranks` is kept by reference.
  CubeTurns(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches)
      : ranks_(ranks), batches_(std::move(batches)), first_rank_(ranks) {}

  /// A file of the cube's: `write` makes it on rank 0, where others' planes go, too.
  std::unique_ptr<imager::ImageWriter> open(const std::function<std::unique_ptr<imager::ImageWriter>()>& write);
  /// A part of the batches for each rank, where all ranks have the same to do with them.
  std::vector<imager::PlaneRange> own_batches() const;
  /// Makes planes until there are no more, or the user stops: planes that are done by then stay. On rank 0 take(plane) is told
  /// of all, in their order, one at a time. Returns whether the user stopped it. Throws what CubeVisibilities and CubePlanes do
  /// but for Interrupted.
  bool make(CubeVisibilities& visibilities, CubePlanes& planes, const std::function<void(CubePlane&&)>& take,
            ProgressLine& progress, imager::StageTimes& times);

 private:
  struct Work;

  void make_for_all(const Work& work, const std::function<void(CubePlane&&)>& take);
  void make_for_first(const Work& work);
  void visit(const Work& work, const std::function<std::optional<imager::PlaneRange>()>& next,
             const std::function<void(CubePlane&&)>& put);

  const imager::Ranks& ranks_;
  std::vector<imager::PlaneRange> batches_;
  PlaneLink first_rank_;  ///< of the others
  std::atomic<bool> stopped_ = false;
};

}  // namespace misfit::tools
