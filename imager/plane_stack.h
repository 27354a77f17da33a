#pragma once

#include <cstddef>
#include <vector>

#include "imager/facet.h"
#include "imager/half_grid.h"

namespace misfit::imager {

/// The shape of a grid over the whole uv plane. Cell (p, q) stands for u = −p/(nu · cell), v = q/(nv · cell), both taken modulo
/// the grid; a margin keeps the taps that leave it, and is folded in before the FFT.
struct StackShape {
  int nu = 0;     ///< length of the FFT along u
  int nv = 0;     ///< along v
  int width = 0;  ///< of the kernel, in cells
  int tile = 0;   ///< side of a tile, in cells; at least `width`

  int margin() const { return width / 2; }
  int tiles_u() const { return (nu + 2 * margin() + 1) / tile + 1; }
  int tiles_v() const { return (nv + 2 * margin() + 1) / tile + 1; }
  /// Storage, margins included: room for a whole tile with the taps that leave it.
  int columns() const { return (tiles_u() + 1) * tile; }
  int rows() const { return (tiles_v() + 1) * tile; }
  std::size_t cells() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
};

/// Some neighbouring planes of constant w, each with one or more complex grids: [plane][component][row][column], components
/// being real and imaginary parts in turn.
template <typename Real>
struct PlaneStack {
  StackShape shape;
  int planes = 0;
  int components = 2;
  std::vector<Real> cell;
  std::vector<char> row_used;  ///< [row]: whether any plane may hold something there

  PlaneStack(const StackShape& stack_shape, int plane_count, int component_count)
      : shape(stack_shape),
        planes(plane_count),
        components(component_count),
        cell(shape.cells() * static_cast<std::size_t>(plane_count * component_count)),
        row_used(static_cast<std::size_t>(shape.rows())) {}

  Real* row(int plane, int component, int r) {
    return cell.data() + shape.cells() * static_cast<std::size_t>(plane * components + component) +
           static_cast<std::size_t>(r) * static_cast<std::size_t>(shape.columns());
  }
  const Real* row(int plane, int component, int r) const { return const_cast<PlaneStack*>(this)->row(plane, component, r); }
};

/// Which w a stack's planes stand for: plane k has w = (first + k) · step, in wavelengths.
struct PlaneHeights {
  int first = 0;
  double step = 0;
};

/// image_i(x, y) += Re Σ_k Σ_{p,q} G_{k,i}(p, q) exp(+2πi(px/nu + qy/nv + w_k q_w(x, y))) for the i-th complex grid of every
/// plane; q_w is the facet's curvature. Pixels beyond the horizon are left as they are. Neither correction nor division.
template <typename Real>
void add_stack_to_images(const PlaneStack<Real>& stack, const Facet& facet, const PlaneHeights& heights, int threads,
                         const std::vector<Image*>& images);

/// The adjoint, for a stack of one complex grid a plane: G_k(p, q) = Σ_{x,y} image(x, y) exp(−2πi(px/nu + qy/nv + w_k q_w)),
/// margins filled by periodicity. Pixels beyond the horizon are not used.
template <typename Real>
void image_to_stack(const Image& image, const Facet& facet, const PlaneHeights& heights, int threads, PlaneStack<Real>& stack);

}  // namespace misfit::imager
