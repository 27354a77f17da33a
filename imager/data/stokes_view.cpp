#include "imager/data/stokes_view.h"

#include <string>

namespace misfit::imager {
namespace {

class StokesStream : public BlockStream {
 public:
  StokesStream(std::unique_ptr<BlockStream> from, std::size_t index) : from_(std::move(from)), index_(index) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    auto block = from_->next();
    if (!block || index_ == 0) return block;
    if (index_ > block->other_stokes.size())
      throw std::invalid_argument("Stokes parameter " + std::to_string(index_) + " of a block that carries " +
                                  std::to_string(1 + block->other_stokes.size()) + "; they count from 0");
    return block->other_stokes[index_ - 1];
  }

 private:
  std::unique_ptr<BlockStream> from_;
  std::size_t index_;
};

}  // namespace

StokesView::StokesView(const VisibilitySource& from, int index) : from_(from), index_(static_cast<std::size_t>(index)) {
  if (index < 0) throw std::invalid_argument("Stokes parameter " + std::to_string(index) + "; expected 0 or more");
}

std::unique_ptr<BlockStream> StokesView::open() const {
  return std::make_unique<StokesStream>(from_.open(), index_);
}

}  // namespace misfit::imager
