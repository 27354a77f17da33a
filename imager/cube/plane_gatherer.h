#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/cube/gathered_rows.h"
#include "imager/data/stored_visibilities.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// About this many samples of a plane are gridded together, if there are as many: each tile of the grid then has more than a
/// few.
inline constexpr std::size_t samples_gathered_at_once = std::size_t{1} << 19;

/// Deals the samples of blocks out to the planes of a cube. A plane gets the same samples of the same blocks for any number of
/// threads, and whichever other planes are gathered.
class PlaneGatherer {
 public:
  /// `expected_samples` of all blocks together make room for as many beforehand.
  PlaneGatherer(const CubeSampling& sampling, const PlaneRange& range, int threads, std::uint64_t expected_samples = 0);

  /// Throws std::invalid_argument when the block does not tell the widths of its channels.
  void add(const VisibilityBlock& block);
  /// The groups of rows that are large enough to be gridded together, or, with `all`, after the last add(), all groups; in
  /// order.
  std::vector<std::unique_ptr<GatheredRows>> take(bool all);
  /// The number of usable samples added that lie in no plane of the cube: below all planes where the range has the first plane,
  /// and above all where it has the last.
  std::uint64_t outside_planes() const { return outside_planes_; }

 private:
  std::vector<MappedRows> rows_of(const VisibilityBlock& block) const;
  void count_outside(const VisibilityBlock& block, const std::vector<MappedRows>& rows);

  CubeSampling sampling_;
  PlaneRange range_;
  int threads_;
  std::uint64_t expected_samples_;
  /// The rows of a window, known by its frequencies; windows are in the order in which they appeared.
  struct Window {
    std::vector<double> frequency_hz;
    std::unique_ptr<GatheredRows> growing;  ///< null where no group is begun
  };
  Window& window_of(const VisibilityBlock& block);

  std::vector<Window> windows_;
  std::vector<std::unique_ptr<GatheredRows>> full_;
  std::uint64_t outside_planes_ = 0;
};

/// The visibilities of some planes, counted from the first of them.
class GatheredPlanes {
 public:
  /// The counts of a pass.
  struct Counts {
    SampleCounts read;                 ///< of the blocks that were read
    std::uint64_t outside_planes = 0;  ///< usable samples that lie in no plane of the cube
  };
  GatheredPlanes() = default;
  GatheredPlanes(std::vector<std::unique_ptr<GatheredRows>> rows, const Counts& counts)
      : rows_(std::move(rows)), counts_(counts) {}

  /// The visibilities of one plane, made anew. May be called for different planes at the same time.
  StoredVisibilities plane(int plane) const;
  /// The visibilities of one plane, which are held no longer.
  StoredVisibilities take(int plane);
  const Counts& counts() const { return counts_; }

 private:
  std::vector<std::unique_ptr<GatheredRows>> rows_;
  Counts counts_;
};

/// One pass over `source`. Stages timed: "read", "planes".
GatheredPlanes gather_planes(const VisibilitySource& source, const CubeSampling& sampling, const PlaneRange& range,
                             const Context& context);

/// One plane of a cube as a source of its own, gathered in every pass over another.
class PlaneView : public VisibilitySource {
 public:
  /// `from` must outlive this.
  PlaneView(const VisibilitySource& from, const CubeSampling& sampling, int plane)
      : from_(from), sampling_(sampling), plane_(plane) {}

  std::unique_ptr<BlockStream> open() const override;
  /// The samples of the source: how many of them are the plane's is known only once they are read.
  std::uint64_t samples() const override { return from_.samples(); }

 private:
  const VisibilitySource& from_;
  CubeSampling sampling_;
  int plane_;
};

}  // namespace misfit::imager
