#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "imager/data/visibilities.h"
#include "imager/numerics/constants.h"
#include "imager/weighting/uv_cells.h"

namespace misfit::imager::testing {

/// The density by definition: the whole plane, and every sample in it twice.
class PlainDensity {
 public:
  using Cell = std::pair<int, int>;  ///< floor(u N cell), floor(v N cell)

  PlainDensity(const ImageGeometry& geometry, const std::vector<VisibilityBlock>& blocks) : geometry_(geometry) {
    for (const VisibilityBlock& block : blocks)
      for_each(block, [&](std::size_t row, std::size_t channel, const Cell&, std::uint32_t) {
        for (const double sign : {1., -1.})
          weight_[cell_of(block, row, channel, sign)] += double{block.weight[row * block.channels() + channel]};
      });
  }

  double at(const Cell& cell) const {
    const auto found = weight_.find(cell);
    return found == weight_.end() ? 0 : found->second;
  }
  const std::map<Cell, double>& cells() const { return weight_; }

  /// Calls visit(row, channel, cell, index in UvCells) for every usable sample within 1/(2 cell).
  template <typename Visit>
  void for_each(const VisibilityBlock& block, const Visit& visit) const {
    const UvCells cells(geometry_);
    std::vector<std::uint32_t> index(block.channels());
    for (std::size_t row = 0; row < block.rows(); ++row) {
      cells.of_row(&block.uvw_m[3 * row], cells.turns_per_m(block.frequency_hz), index.data());
      for (std::size_t c = 0; c < block.channels(); ++c) {
        const bool within = std::abs(turns(block, row, c, 0)) <= 0.5 && std::abs(turns(block, row, c, 1)) <= 0.5;
        if (block.weight[row * block.channels() + c] > 0 && within) visit(row, c, cell_of(block, row, c, 1), index[c]);
      }
    }
  }

 private:
  double turns(const VisibilityBlock& block, std::size_t row, std::size_t channel, std::size_t axis) const {
    return block.uvw_m[3 * row + axis] * block.frequency_hz[channel] / speed_of_light_m_s * geometry_.cell_rad;
  }
  Cell cell_of(const VisibilityBlock& block, std::size_t row, std::size_t channel, double sign) const {
    return {static_cast<int>(std::floor(sign * turns(block, row, channel, 0) * geometry_.width)),
            static_cast<int>(std::floor(sign * turns(block, row, channel, 1) * geometry_.height))};
  }

  ImageGeometry geometry_;
  std::map<Cell, double> weight_;
};

}  // namespace misfit::imager::testing
