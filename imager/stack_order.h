#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "imager/facet.h"
#include "imager/plane_stack.h"
#include "imager/tile_order.h"
#include "imager/visibilities.h"

namespace misfit::imager {

/// Turns UVW into cells of the planes of a facet.
struct StackScale {
  StackScale(const StackShape& shape, const Facet& facet, double plane_step);

  double u_cells_per_m_hz = 0;
  double v_cells_per_m_hz = 0;
  double planes_per_m_hz = 0;
  double turns_per_m_hz = 0;  ///< 1/c
  Facet facet;
};

/// A row of UVW at unit frequency, sheared for the facet. Planes lie at w = (k + ½) steps, and those of k < 0 are left out,
/// since V(−u, −v, −w) = conj V(u, v, w): what a sample has to do with them, its mirror image has to do with plane −1 − k.
struct StackRow {
  double u_per_hz = 0;      ///< cells
  double v_per_hz = 0;      ///< cells
  double w_per_hz = 0;      ///< steps of planes
  double turns_per_hz = 0;  ///< u l_0 + v m_0 + w middle: the phase of the facet's middle pixel
  bool mirrored = false;

  /// Of the mirror image (u, v, w) are negated, and the visibility is the conjugate.
  StackRow(const double* uvw_m, bool mirrored, const StackScale& scale);

  /// The place among planes. The taps of a sample and of its mirror image must be each other's, wherever rounding puts an edge.
  TapPosition along_w(double frequency_hz, int width) const {
    const double steps = w_per_hz * frequency_hz;
    TapPosition at((mirrored ? -steps : steps) - 0.5, width);
    if (mirrored) {
      at.first = -width - at.first;
      at.t = -at.t;
    }
    return at;
  }
};

/// Cells reduced by the grid's period to [0, n).
inline double reduced(double cells, int n) {
  return cells - n * std::floor(cells / n);
}

/// Consecutive channels of one row, or of its mirror image, that fall into one tile and have one lowest plane.
struct StackRun {
  std::uint32_t block;
  std::uint32_t row;
  std::int32_t plane;  ///< of the first tap; may lie below 0
  std::uint32_t first : 20;
  std::uint32_t count : 11;
  std::uint32_t mirrored : 1;
};

/// Samples in the order in which tiles are visited: runs of tile i are run[begin[i]] … run[begin[i + 1] − 1], by plane and then
/// in the order of the blocks.
struct StackOrder {
  std::vector<std::size_t> begin;  ///< [tile + 1]
  std::vector<StackRun> run;
  std::vector<char> plane_used;  ///< [plane]: whether any tap falls there
};

struct StackOrderOptions {
  StackShape shape;
  int width_w = 1;
  StackScale scale;
  int threads = 1;
};

/// Orders the samples that `wanted(block, sample)` accepts, and their mirror images, by the tile and the plane of their first
/// tap; those that touch a plane.
StackOrder order_for_stack(const std::vector<const SampleCoordinates*>& blocks,
                           const std::function<bool(std::size_t block, std::size_t sample)>& wanted,
                           const StackOrderOptions& options);

}  // namespace misfit::imager
