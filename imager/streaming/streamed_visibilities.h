#pragma once

#include <mutex>

#include "imager/data/extent.h"
#include "imager/data/stored_visibilities.h"
#include "imager/streaming/uv_coverage.h"
#include "imager/weighting/imaging_weights.h"

namespace misfit::imager {

struct StreamingOptions {
  bool keep = true;            ///< whether the blocks of the first pass stay in memory: of all ranks or of none
  std::size_t ahead = 2;       ///< blocks read ahead of their user
  double uv_reach_lambda = 0;  ///< up to where the uv coverage is gathered; 0: nowhere
};

/// Another source, read ahead of its user, in the same blocks. The first pass that is read to its end gives the counts, and may
/// serve all later passes from memory. A pass without a usable sample ends in NothingUsable; where ranks share the samples,
/// end_pass() throws it, once it is known of all ranks.
class StreamedVisibilities : public VisibilitySource {
 public:
  /// `from` must outlive this.
  StreamedVisibilities(const VisibilitySource& from, const StreamingOptions& options);

  std::unique_ptr<BlockStream> open() const override;
  std::uint64_t samples() const override { return from_.samples(); }
  const Ranks& ranks() const override { return from_.ranks(); }
  void end_pass() const override;
  /// Gives all passes from now on these weights, in place of `from`'s: at once where blocks are kept, else as they are read. To
  /// be called once at most, while nobody reads, and by all ranks.
  void apply(std::shared_ptr<const ImagingWeights> weights, int threads);
  /// The counts of a full pass; zero before there was one.
  SampleCounts counts() const;
  WSpread w_spread() const;
  UvCoverage uv_coverage() const;
  /// Zero where no weights were applied.
  WeightSums weight_sums() const;

 private:
  /// The facts from a pass.
  struct Pass {
    SampleCounts counts;
    WeightTotals weights;  ///< only their spread where none were applied
    UvCoverage uv_coverage;
    StoredVisibilities blocks;
    bool of_all_ranks = false;
  };
  class Recorder;
  class Weighted;

  std::shared_ptr<const Pass> first_pass() const;
  void finish(std::shared_ptr<Pass> pass) const;

  const VisibilitySource& from_;
  const StreamingOptions options_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<Pass> first_pass_;       ///< null until one is complete
  std::shared_ptr<const ImagingWeights> weights_;  ///< of blocks as they are read; null: as `from` has them
};

}  // namespace misfit::imager
