#pragma once

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Another source with weights times exp(−ln 100 · (u² + v²) (2 cell)²): a hundredth at |u| = 1/(2 cell), beyond which an image
/// of this cell has none. The tapered data suit its pixels: the main lobe of the PSF is 2.3 pixels wide or more, and the edge
/// of the grid cuts off nothing that would ring.
class TaperedVisibilities : public VisibilitySource {
 public:
  /// `from` must outlive this.
  TaperedVisibilities(const VisibilitySource& from, double cell_rad) : from_(from), cell_rad_(cell_rad) {}

  std::unique_ptr<BlockStream> open() const override;
  std::uint64_t samples() const override { return from_.samples(); }
  const Ranks& ranks() const override { return from_.ranks(); }
  void end_pass() const override { from_.end_pass(); }

 private:
  const VisibilitySource& from_;
  double cell_rad_;
};

}  // namespace misfit::imager
