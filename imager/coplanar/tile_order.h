#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "imager/coplanar/half_grid.h"
#include "imager/data/geometry.h"
#include "imager/numerics/constants.h"
#include "imager/transform/sampling.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// Turns UVW into cells of a HalfGrid.
struct CellScale {
  double u_cells_per_m_hz = 0;  ///< −cell_rad · nu / c
  double v_cells_per_m_hz = 0;  ///< +cell height · nv / c

  CellScale(const GridShape& shape, const ImageGeometry& geometry)
      : u_cells_per_m_hz(-geometry.cell_rad * shape.nu / speed_of_light_m_s),
        v_cells_per_m_hz(geometry.cell_height_rad() * shape.nv / speed_of_light_m_s) {}
};

/// A row of UVW at unit frequency, folded to v ≥ 0.
struct FoldedRow {
  double u_per_hz = 0;  ///< cells
  double v_per_hz = 0;
  bool folded = false;  ///< (u, v) were negated; the visibility is the conjugate

  FoldedRow(const double* uvw_m, const CellScale& scale)
      : u_per_hz(uvw_m[0] * scale.u_cells_per_m_hz), v_per_hz(uvw_m[1] * scale.v_cells_per_m_hz), folded(v_per_hz < 0) {
    if (folded) {
      u_per_hz = -u_per_hz;
      v_per_hz = -v_per_hz;
    }
  }
  /// True if |u| and |v| reach no further than the grid at this frequency and below.
  bool within(const GridShape& shape, double frequency_hz) const {
    return std::abs(u_per_hz) * frequency_hz <= 0.5 * shape.nu && v_per_hz * frequency_hz <= 0.5 * shape.nv;
  }
};

/// Where the taps of a sample lie along one axis: the first cell they touch, and the position of the sample within its cell.
struct TapPosition {
  int first = 0;
  double t = 0;

  TapPosition(double cells, int width) : first(floor_to_int(cells - 0.5 * width + 1)), t(cells - first - 0.5 * (width - 1)) {}
};

/// Consecutive samples that fall into one tile: channels of one row; or rows, where there is one channel.
struct SampleRun {
  std::uint32_t row;
  std::uint32_t first : 20;  ///< channel
  std::uint32_t count : 12;
};

/// The samples of a block in the order in which tiles are visited: runs of tile i are run[begin[i]] … run[begin[i + 1] − 1], in
/// the order of the rows.
struct TileOrder {
  std::vector<std::size_t> begin;    ///< [tile + 1]
  std::vector<std::size_t> samples;  ///< [tile]
  std::vector<SampleRun> run;
  double highest_frequency_hz = 0;  ///< of the block
  std::vector<SampleSums> sums;     ///< [set]: when imaging, of the samples in the order, and those outside the grid
};

/// Throws std::invalid_argument when there are more channels than a run can count.
void check_channels(std::size_t channels);

/// The samples that are wanted. imaging: of weight not 0, inside the grid, with their sums; imaging_beyond: beyond the grid
/// too; usable: of weight not 0, for prediction; all: all.
enum class Wanted { imaging, imaging_beyond, usable, all };

/// Orders the wanted samples by the tile of their first tap. `block` needs weights unless all are wanted; sums are taken of
/// each of the sets.
TileOrder order_by_tile(const VisibilityBlock& block, const VisibilitySets& sets, const GridShape& shape,
                        const ImageGeometry& geometry, Wanted wanted, int threads);

/// Cells reduced by the period of the grid to [−n/2, n/2] along u and [0, n/2] along v, as prediction beyond the grid needs.
/// Inside the grid nothing changes.
struct PeriodicPosition {
  double u = 0;
  double v = 0;
  bool conjugate = false;

  PeriodicPosition(double u_cells, double v_cells, bool folded, const GridShape& shape)
      : u(u_cells), v(v_cells), conjugate(folded) {
    if (v > 0.5 * shape.nv) {
      v -= shape.nv * std::round(v / shape.nv);
      if (v < 0) {
        u = -u;
        v = -v;
        conjugate = !conjugate;
      }
    }
    if (std::abs(u) > 0.5 * shape.nu) u -= shape.nu * std::round(u / shape.nu);
  }
};

}  // namespace misfit::imager
