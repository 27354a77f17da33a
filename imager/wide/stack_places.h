#pragma once

#include <cstdint>

#include "imager/coplanar/tile_positions.h"
#include "imager/wide/facet.h"
#include "imager/wide/plane_stack.h"

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

/// A row of UVW at unit frequency, sheared for the facet. Planes lie at w = (k + ½) steps, whole k of either sign.
struct StackRow {
  double u_per_hz = 0;      ///< cells
  double v_per_hz = 0;      ///< cells
  double w_per_hz = 0;      ///< steps of planes
  double turns_per_hz = 0;  ///< u l_0 + v m_0 + w middle: the phase of the facet's middle pixel

  /// For the mirror image (u, v, w) are negated, and the visibility is the conjugate.
  StackRow(const double* uvw_m, bool mirrored, const StackScale& scale);
};

/// The first taps of samples of a row, or of their mirror images.
struct FirstTaps {
  std::int32_t* tile;      ///< row of tiles × tiles in a row + column
  std::int32_t* plane;     ///< k
  std::int32_t* mirrored;  ///< 1 where the sample falls into the half of the grid with v < 0, so that its mirror image is taken
  double* period;          ///< a number for the grid's periods along u and v; equal where both are equal
};

/// Writes the first taps at `count` frequencies of a row that is not mirrored, for kernels of `width_w` planes along w.
void first_taps(const StackRow& row, const StackShape& shape, int width_w, const double* frequency_hz, int count,
                const FirstTaps& out);

/// The row as the tile sees it, for samples of the same period as the one at `frequency_hz`.
RowInTile row_in_tile(const StackRow& row, const StackShape& shape, int tile_u, int tile_v, double frequency_hz);

}  // namespace misfit::imager
