#pragma once

#include <vector>

#include "imager/tap_table.h"

namespace misfit::imager {

/// Samples on their way to or from one tile of a stack of planes. Plane, row and column are those of the first tap in the
/// tile's buffer; the plane may lie below or above the stack, of which only the taps within count. t as in
/// kernels::TapFunction.
template <typename Real>
struct StackBatch {
  static constexpr int capacity = 128;
  int count = 0;
  int plane[capacity];
  int row[capacity];
  int column[capacity];
  Real tu[capacity];
  Real tv[capacity];
  Real tw[capacity];
  Real value[4][capacity];  ///< [component]
};

/// A tile's private piece of a stack, with room for the taps that leave the tile: [plane][row][component][column].
template <typename Real>
struct StackBuffer {
  int planes = 0;
  int components = 0;
  int rows = 0;
  int columns = 0;
  std::vector<Real> cell;

  StackBuffer(int tile, int padded_width, int plane_count, int component_count)
      : planes(plane_count),
        components(component_count),
        rows(tile + padded_width),
        columns(tile + padded_width),
        cell(static_cast<std::size_t>(plane_count * rows) * static_cast<std::size_t>(component_count * columns)) {}
  Real* row(int plane, int r, int component) {
    return cell.data() +
           static_cast<std::size_t>((plane * rows + r) * components + component) * static_cast<std::size_t>(columns);
  }
  const Real* row(int plane, int r, int component) const { return const_cast<StackBuffer*>(this)->row(plane, r, component); }
};

/// Kernels along the three axes; those along u and v have one width.
template <typename Real>
struct StackTaps {
  TapTable<Real> u;
  TapTable<Real> v;
  TapTable<Real> w;
};

/// Adds value · C_u · C_v · C_w of every sample to the buffer, for 2 or 4 components.
void spread(const StackTaps<float>& taps, const StackBatch<float>& samples, StackBuffer<float>& buffer);
void spread(const StackTaps<double>& taps, const StackBatch<double>& samples, StackBuffer<double>& buffer);

/// Sets the first two components of every sample to Σ C_u · C_v · C_w · buffer: the transpose of spread.
void interpolate(const StackTaps<float>& taps, const StackBuffer<float>& buffer, StackBatch<float>& samples);
void interpolate(const StackTaps<double>& taps, const StackBuffer<double>& buffer, StackBatch<double>& samples);

}  // namespace misfit::imager
