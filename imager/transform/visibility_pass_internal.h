#pragma once

#include <complex>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "imager/transform/imaging.h"

namespace misfit::imager {

/// One pass over visibilities; a source that reads ahead begins when this is made.
class VisibilityPass {
 public:
  using Blocks = std::vector<std::shared_ptr<const VisibilityBlock>>;

  VisibilityPass(const VisibilitySource& source, const Context& context)
      : source_(source), stream_(source.open()), context_(context) {}

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
      context_.tell(done, source_.samples());
      group.clear();
      gathered = 0;
    };
    while (auto block = next()) {
      gathered += block->samples();
      group.push_back(std::move(block));
      if (gathered >= samples) finish();
    }
    if (!group.empty()) finish();
    source_.end_pass();
  }

 private:
  std::shared_ptr<const VisibilityBlock> next() {
    const StageTimer timer(context_.times, stage::read);
    return stream_->next();
  }

  const VisibilitySource& source_;
  std::unique_ptr<BlockStream> stream_;
  const Context& context_;
};

inline std::unique_ptr<AdjointSum> begin_adjoint(const Transform& transform, const AdjointOptions& options,
                                                 const Context& context) {
  const StageTimer timer(context.times, stage::grid);
  return transform.adjoint(options);
}

/// Makes the image at rank 0 the sum over all ranks, and empty at others.
inline void add_up(Image& image, const Ranks& ranks) {
  ranks.sum_at_first(image.pixel.data(), image.pixel.size());
  if (!ranks.first()) image = {};
}

/// The result for the samples of all ranks, with images at rank 0 alone. Also frees the grid.
inline AdjointResult finish_adjoint(std::unique_ptr<AdjointSum> sum, const Ranks& ranks, const Context& context) {
  AdjointResult result;
  {
    const StageTimer timer(context.times, stage::grid);
    result = sum->finish();
    sum.reset();
  }
  context.move_seconds(stage::grid, stage::fft, result.fft_s);
  if (ranks.alone()) return result;
  const StageTimer timer(context.times, stage::exchange);
  for (Image& image : result.images) add_up(image, ranks);
  add_up(result.psf, ranks);
  ranks.sum(result.sensitivity.pixel.data(), result.sensitivity.pixel.size());  // which every rank needs
  for (Image& further : result.further_sensitivity) ranks.sum(further.pixel.data(), further.pixel.size());
  for (SampleSums& sums : result.sums) sums.add_up(ranks);
  return result;
}

}  // namespace misfit::imager
