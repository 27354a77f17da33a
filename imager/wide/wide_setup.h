#pragma once

#include <algorithm>
#include <vector>

#include "imager/wide/stack_columns.h"
#include "imager/wide/stack_walk.h"
#include "imager/wide/touched_cells.h"
#include "imager/wide/wide_transform.h"

namespace misfit::imager {

/// Data that adjoint and prediction of a wide transform share: the kernels' taps, and the shape of every facet's stack.
template <typename Real>
struct WideSetup {
  WideTransformOptions options;
  StackShape shape;
  StackTaps<Real> taps;
  std::vector<StackedFacet> facets;  ///< facets that reach above the horizon

  StackOrderOptions ordering(const StackedFacet& f) const {
    return {shape, taps.w.width, StackScale(shape, f.facet, f.plane_step), options.threads};
  }
};

/// The stack of a facet.
StackShape stack_shape_of(const WideTransformOptions& options);

template <typename Real>
WideSetup<Real> wide_setup(const WideTransformOptions& options);

/// Pairs of opposite half planes of one facet, of so many grids each, that memory can hold.
int most_pairs(const WideTransformOptions& options, int grids);
/// Rows of tiles in a band: as many as a cache shared among processors can hold.
int tiles_a_band(const WideTransformOptions& options, int pairs, int grids);
/// Bytes of a band of `pairs` pairs, and of the columns that the image keeps of it.
double bytes_of_pairs(const WideTransformOptions& options, int pairs, int grids);

/// Calls visit(row, chunk, plane, grid, cells) for rows and planes that a tile's buffer and a stack share, in the stack's
/// order.
template <typename Visit>
void for_each_chunk(const StackShape& s, const TouchedRange& rows, const TouchedRange& planes, int grids, const Visit& visit) {
  for (int row = rows.begin; row < rows.end; ++row)
    for (int chunk = 0; chunk < 2; ++chunk)
      for (int plane = planes.begin; plane < planes.end; ++plane)
        for (int grid = 0; grid < grids; ++grid) visit(row, chunk, plane, grid, std::min(s.tile, s.reach() - chunk * s.tile));
}

template <typename Real>
StackBuffer<Real> buffer_of(const WideSetup<Real>& setup, int grids) {
  return StackBuffer<Real>(setup.shape.tile, setup.shape.width, grids);
}

/// True if a tile holds so few samples that it is gridded and degridded in place in the stack: a buffer costs more to bring and
/// to add.
bool is_sparse(const StackOrder& order, const StackTask& task);

}  // namespace misfit::imager
