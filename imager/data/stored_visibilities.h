#pragma once

#include <vector>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Blocks kept in memory, so that later passes need no reading.
class StoredVisibilities : public VisibilitySource {
 public:
  void append(std::shared_ptr<const VisibilityBlock> block) {
    samples_ += block->samples();
    blocks_.push_back(std::move(block));
  }
  /// To be changed while nobody reads.
  std::vector<std::shared_ptr<const VisibilityBlock>>& blocks() { return blocks_; }
  std::unique_ptr<BlockStream> open() const override { return std::make_unique<Stream>(blocks_); }
  std::uint64_t samples() const override { return samples_; }

 private:
  class Stream : public BlockStream {
   public:
    explicit Stream(const std::vector<std::shared_ptr<const VisibilityBlock>>& blocks) : blocks_(blocks) {}
    std::shared_ptr<const VisibilityBlock> next() override { return at_ < blocks_.size() ? blocks_[at_++] : nullptr; }

   private:
    const std::vector<std::shared_ptr<const VisibilityBlock>>& blocks_;
    std::size_t at_ = 0;
  };

  std::vector<std::shared_ptr<const VisibilityBlock>> blocks_;
  std::uint64_t samples_ = 0;
};

}  // namespace misfit::imager
