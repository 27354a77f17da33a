#pragma once

#include <complex>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "imager/imaging.h"

namespace misfit::imager {

/// One pass over visibilities; a source that reads ahead begins when this is made.
class VisibilityPass {
 public:
  using Blocks = std::vector<std::shared_ptr<const VisibilityBlock>>;

  VisibilityPass(const VisibilitySource& source, const Progress& progress, StageTimes& times)
      : total_(source.samples()), stream_(source.open()), progress_(progress), times_(times) {}

  /// Calls visit(block) for every block.
  template <typename Visit>
  void for_each_block(const Visit& visit) {
    for_each_group(0, [&](const Blocks& group) { visit(*group.front()); });
  }
  /// Calls visit(blocks) for groups of blocks, of at least `samples` but for the last.
  template <typename Visit>
  void for_each_group(std::size_t samples, const Visit& visit) {
    std::uint64_t done = 0;
    Blocks group;
    std::size_t gathered = 0;
    const auto finish = [&] {
      visit(group);
      done += gathered;
      progress_(done, total_);
      group.clear();
      gathered = 0;
    };
    while (auto block = next()) {
      gathered += block->samples();
      group.push_back(std::move(block));
      if (gathered >= samples) finish();
    }
    if (!group.empty()) finish();
  }

 private:
  std::shared_ptr<const VisibilityBlock> next() {
    const StageTimer timer(times_, "read");
    return stream_->next();
  }

  std::uint64_t total_;
  std::unique_ptr<BlockStream> stream_;
  const Progress& progress_;
  StageTimes& times_;
};

inline std::unique_ptr<AdjointSum> begin_adjoint(const Transform& transform, const AdjointOptions& options, StageTimes& times) {
  const StageTimer timer(times, "grid");
  return transform.adjoint(options);
}

/// That of the samples of all ranks. Also frees the grid.
inline AdjointResult finish_adjoint(std::unique_ptr<AdjointSum> sum, const Ranks& ranks, StageTimes& times) {
  AdjointResult result;
  {
    const StageTimer timer(times, "grid");
    result = sum->finish();
    sum.reset();
  }
  times.move("grid", "fft", result.fft_s);
  if (ranks.alone()) return result;
  const StageTimer timer(times, "exchange");
  for (Image& image : result.images) ranks.sum(image.pixel.data(), image.pixel.size());
  ranks.sum(result.psf.pixel.data(), result.psf.pixel.size());
  for (SampleSums& sums : result.sums)
    sum_over(ranks, sums.used, sums.outside_grid, sums.weight, sums.weight_abs, sums.weight_square, sums.weight2_square);
  return result;
}

}  // namespace misfit::imager
