#include "imager/streaming/streamed_visibilities.h"

#include <utility>

#include "imager/streaming/prefetch.h"

namespace misfit::imager {

/// Hands on the blocks of a stream, weighted, and hands in the pass's facts at its end.
class StreamedVisibilities::Recorder : public BlockStream {
 public:
  Recorder(const StreamedVisibilities& source, std::unique_ptr<BlockStream> stream)
      : source_(source), stream_(std::move(stream)) {
    pass_->uv_coverage = UvCoverage(source.options_.uv_reach_lambda);
  }

  std::shared_ptr<const VisibilityBlock> next() override {
    auto block = stream_->next();
    if (block) {
      block = weighted(std::move(block));
      pass_->counts += block->counts;
      pass_->uv_coverage.add(*block);
      if (source_.options_.keep) pass_->blocks.append(block);
    } else {
      if (pass_->counts.used == 0 && source_.ranks().alone()) throw NothingUsable(pass_->counts);
      source_.finish(pass_);
    }
    return block;
  }

 private:
  std::shared_ptr<const VisibilityBlock> weighted(std::shared_ptr<const VisibilityBlock> block) {
    if (source_.weights_) {
      WeightedBlock made = source_.weights_->of(std::move(block));
      pass_->weights += made.totals;
      return std::move(made.block);
    }
    pass_->weights.w_spread.add(*block);
    return block;
  }

  const StreamedVisibilities& source_;
  std::unique_ptr<BlockStream> stream_;
  std::shared_ptr<Pass> pass_ = std::make_shared<Pass>();
};

/// Hands on the blocks of a stream, weighted.
class StreamedVisibilities::Weighted : public BlockStream {
 public:
  Weighted(const ImagingWeights& weights, std::unique_ptr<BlockStream> stream)
      : weights_(weights), stream_(std::move(stream)) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    auto block = stream_->next();
    return block ? weights_.of(std::move(block)).block : nullptr;
  }

 private:
  const ImagingWeights& weights_;
  std::unique_ptr<BlockStream> stream_;
};

StreamedVisibilities::StreamedVisibilities(const VisibilitySource& from, const StreamingOptions& options)
    : from_(from), options_(options) {}

std::unique_ptr<BlockStream> StreamedVisibilities::open() const {
  const auto pass = first_pass();
  if (pass && options_.keep) return pass->blocks.open();
  auto stream = from_.open();
  if (!pass)
    stream = std::make_unique<Recorder>(*this, std::move(stream));
  else if (weights_)
    stream = std::make_unique<Weighted>(*weights_, std::move(stream));
  return prefetched(std::move(stream), options_.ahead);
}

void StreamedVisibilities::end_pass() const {
  const std::lock_guard lock(mutex_);
  if (ranks().alone() || !first_pass_ || first_pass_->of_all_ranks) return;
  first_pass_->counts.add_up(ranks());
  first_pass_->weights.add_up(ranks());
  first_pass_->uv_coverage.add_up(ranks());
  first_pass_->of_all_ranks = true;
  if (first_pass_->counts.used == 0) throw NothingUsable(first_pass_->counts);
}

void StreamedVisibilities::apply(std::shared_ptr<const ImagingWeights> weights, int threads) {
  const std::lock_guard lock(mutex_);
  if (first_pass_ && options_.keep) {
    first_pass_->weights = weights->put_on(first_pass_->blocks, threads);
    first_pass_->weights.add_up(ranks());
    return;
  }
  weights_ = std::move(weights);
  first_pass_.reset();
}

SampleCounts StreamedVisibilities::counts() const {
  const auto pass = first_pass();
  return pass ? pass->counts : SampleCounts{};
}

WSpread StreamedVisibilities::w_spread() const {
  const auto pass = first_pass();
  return pass ? pass->weights.w_spread : WSpread{};
}

UvCoverage StreamedVisibilities::uv_coverage() const {
  const auto pass = first_pass();
  return pass ? pass->uv_coverage : UvCoverage(options_.uv_reach_lambda);
}

WeightSums StreamedVisibilities::weight_sums() const {
  const auto pass = first_pass();
  return pass ? pass->weights.sums : WeightSums{};
}

std::shared_ptr<const StreamedVisibilities::Pass> StreamedVisibilities::first_pass() const {
  const std::lock_guard lock(mutex_);
  return first_pass_;
}

void StreamedVisibilities::finish(std::shared_ptr<Pass> pass) const {
  const std::lock_guard lock(mutex_);
  if (!first_pass_) first_pass_ = std::move(pass);
}

}  // namespace misfit::imager
