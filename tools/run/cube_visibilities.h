#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "imager/cube/plane_gatherer.h"
#include "imager/streaming/streamed_visibilities.h"
#include "ms_io/measurement_set.h"
#include "tools/base/progress.h"
#include "tools/run/cube_batches.h"

namespace misfit::tools {

/// What is done with planes of a cube, of a batch several at the same time, each in one thread.
struct PlaneVisitor {
  std::function<std::optional<imager::PlaneRange>()> next;                            ///< those to visit; none: no more
  std::function<void(int channel, imager::StreamedVisibilities& visibilities)> make;  ///< one that has samples
  std::function<void(int channel)> leave_empty;                                       ///< one that has none
  std::function<bool()> stopped;                                                      ///< whether the user wants no more
  std::function<void()> give_up;  ///< one failed: others that are being made are of no use any more
};

/// The visibilities of a cube's planes, as CubeBatches says: held for some planes at a time, or read by each again.
class CubeVisibilities {
 public:
  /// All but `batches` are kept by reference. With `stops_itself` the user's wish to stop is left to the visitor, otherwise it
  /// is thrown.
  CubeVisibilities(const ms_io::MeasurementSet& set, const imager::CubeSampling& sampling, const CubeBatches& batches,
                   int threads, bool stops_itself);

  /// Calls visit(samples of a plane) for every plane of these batches, in passes of its own. Stages timed: "read", "planes".
  void look_through(const std::vector<imager::PlaneRange>& batches,
                    const std::function<void(const imager::VisibilitySource&)>& visit, ProgressLine& progress,
                    imager::StageTimes& times);
  /// Rethrows what a visitor throws, once all planes at work are over; Interrupted last. Stages timed: the same.
  void visit_planes(const PlaneVisitor& visitor, ProgressLine& progress, imager::StageTimes& times);

  /// Of what visit_planes() read; those used are the planes' own.
  const imager::SampleCounts& counts() const { return counts_; }
  /// Usable samples among them that lie in no plane.
  std::uint64_t outside_planes() const { return outside_planes_; }

 private:
  ms_io::FrequencyRange frequencies_of(const imager::PlaneRange& range) const;
  std::unique_ptr<ms_io::MeasurementSet> part_of(const imager::PlaneRange& range) const;
  std::string numbers_of(const imager::PlaneRange& range) const;
  void gather(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times);
  void visit_held(const imager::PlaneRange& batch, const PlaneVisitor& visitor, ProgressLine& progress,
                  imager::StageTimes& times);
  void visit_held(int channel, imager::StoredVisibilities samples, const PlaneVisitor& visitor);
  void visit_streamed(int channel, const PlaneVisitor& visitor);
  void count_read(imager::SampleCounts counts);

  const ms_io::MeasurementSet& set_;
  const imager::CubeSampling& sampling_;
  CubeBatches batches_;
  int threads_;
  bool stops_itself_;
  std::optional<imager::GatheredPlanes> gathered_;  ///< of the batch at hand
  imager::SampleCounts counts_;
  std::uint64_t outside_planes_ = 0;
};

}  // namespace misfit::tools
