#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/imaging.h"
#include "imager/stored_visibilities.h"

namespace misfit::imager {

/// Deals the samples of blocks out to the planes of a cube. The blocks of a plane are the same for any number of threads, and
/// whichever other planes are gathered.
///
/// An interpolated visibility (1 − t) V + t V' needs both samples, and has the weight of that sum, 1/((1 − t)²/w + t²/w'). Rows
/// without a usable sample for a plane are not among its blocks.
class PlaneGatherer {
 public:
  /// `expected_samples` of each plane make room for as many beforehand.
  PlaneGatherer(const CubeSampling& sampling, const PlaneRange& range, int threads, std::uint64_t expected_samples = 0);

  /// Throws std::invalid_argument when the block does not tell the widths of its channels.
  void add(const VisibilityBlock& block);
  /// The blocks of a plane, counted from range.first, that are full, or all there are after the last add().
  std::vector<std::shared_ptr<const VisibilityBlock>> take(int plane, bool all);
  /// Usable samples added that lie in no plane of the cube, and are taken by none of the range.
  std::uint64_t outside_planes() const { return outside_planes_; }

 private:
  /// Rows of one frame ratio.
  struct Rows {
    std::size_t first = 0;
    std::size_t end = 0;
    std::shared_ptr<const ChannelMap> map;
  };
  /// A plane's blocks.
  struct Plane {
    std::map<std::vector<double>, std::shared_ptr<VisibilityBlock>> growing;  ///< by frequencies
    std::vector<std::shared_ptr<const VisibilityBlock>> full;
  };

  std::vector<Rows> rows_of(const VisibilityBlock& block) const;
  /// With room for what is expected, where the plane has no other that grows.
  std::shared_ptr<VisibilityBlock> begin_block(const VisibilityBlock& like, const PlaneChannels& channels, bool alone) const;
  void append(const VisibilityBlock& block, const Rows& rows, const PlaneChannels& channels, Plane& plane) const;
  void count_outside(const VisibilityBlock& block, const std::vector<Rows>& rows);

  CubeSampling sampling_;
  PlaneRange range_;
  int threads_;
  std::vector<Plane> planes_;  ///< [plane − range.first]
  std::size_t expected_samples_;
  std::uint64_t outside_planes_ = 0;
};

/// The visibilities of some planes.
struct GatheredPlanes {
  std::vector<StoredVisibilities> planes;  ///< [plane − range.first]
  SampleCounts counts;                     ///< of the blocks that were read
  std::uint64_t outside_planes = 0;        ///< usable samples that lie in no plane of the cube
};

/// One pass over `source`. Stages timed: "read", "planes".
GatheredPlanes gather_planes(const VisibilitySource& source, const CubeSampling& sampling, const PlaneRange& range, int threads,
                             const Progress& progress, StageTimes& times);

/// One plane of a cube as a source of its own, gathered in every pass over another.
class PlaneView : public VisibilitySource {
 public:
  /// `from` must outlive this.
  PlaneView(const VisibilitySource& from, const CubeSampling& sampling, int plane)
      : from_(from), sampling_(sampling), plane_(plane) {}

  std::unique_ptr<BlockStream> open() const override;
  /// Of the source: how many of them are the plane's is known only once they are read.
  std::uint64_t samples() const override { return from_.samples(); }

 private:
  const VisibilitySource& from_;
  CubeSampling sampling_;
  int plane_;
};

}  // namespace misfit::imager
