#pragma once

#include <utility>

#include "imager/data/stored_visibilities.h"

namespace misfit::imager {

/// Blocks that go to their first reader, which then holds them alone, and may weigh them in place.
class HandedOver : public VisibilitySource {
 public:
  explicit HandedOver(StoredVisibilities visibilities)
      : samples_(visibilities.samples()), blocks_(std::move(visibilities.blocks())) {}

  /// To be called once.
  std::unique_ptr<BlockStream> open() const override { return std::make_unique<Stream>(std::move(blocks_)); }
  std::uint64_t samples() const override { return samples_; }

 private:
  using Blocks = std::vector<std::shared_ptr<const VisibilityBlock>>;

  class Stream : public BlockStream {
   public:
    explicit Stream(Blocks blocks) : blocks_(std::move(blocks)) {}
    std::shared_ptr<const VisibilityBlock> next() override {
      return at_ < blocks_.size() ? std::move(blocks_[at_++]) : nullptr;
    }

   private:
    Blocks blocks_;
    std::size_t at_ = 0;
  };

  std::uint64_t samples_;
  mutable Blocks blocks_;
};

}  // namespace misfit::imager
