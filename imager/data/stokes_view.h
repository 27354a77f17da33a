#pragma once

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Another source's blocks of one of its Stokes parameters: of index 0 those blocks themselves, of index i the i-th of the
/// others that they carry. Nothing is copied.
class StokesView : public VisibilitySource {
 public:
  /// `from` must outlive this. Throws std::invalid_argument when `index` is negative; so does a pass when a block carries no
  /// such Stokes parameter.
  StokesView(const VisibilitySource& from, int index);

  std::unique_ptr<BlockStream> open() const override;
  std::uint64_t samples() const override { return from_.samples(); }
  const Ranks& ranks() const override { return from_.ranks(); }
  void end_pass() const override { from_.end_pass(); }

 private:
  const VisibilitySource& from_;
  std::size_t index_;
};

}  // namespace misfit::imager
