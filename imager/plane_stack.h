#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/big_array.h"
#include "imager/correction.h"
#include "imager/facet.h"
#include "imager/image.h"

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
  int chunks() const { return tiles_u() + 1; }
  int columns() const { return chunks() * tile; }
  int rows() const { return (tiles_v() + 1) * tile; }
  std::size_t cells() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
};

/// Some neighbouring planes of constant w, each with one or more complex grids. What a tile holds of one row lies together:
/// [row][chunk][plane][grid][column in chunk], a chunk being as wide as a tile. Memory is used again from one facet to the
/// next.
template <typename Real>
class PlaneStack {
 public:
  PlaneStack(const StackShape& stack_shape, int grid_count) : shape(stack_shape), grids(grid_count) {}

  /// Makes room for that many planes, whose content is undefined, and marks every row unused.
  void reserve(int plane_count);
  /// Makes the used rows of all planes zero.
  void clear(int threads);

  std::complex<Real>* chunk(int row, int index, int plane, int grid) { return cell_.data() + offset(row, index, plane, grid); }
  const std::complex<Real>* chunk(int row, int index, int plane, int grid) const {
    return cell_.data() + offset(row, index, plane, grid);
  }

  StackShape shape;
  int planes = 0;
  int grids = 1;
  std::vector<char> row_used;  ///< [row]: whether any plane may hold something there; the content of others does not count

 private:
  std::size_t offset(int row, int index, int plane, int grid) const {
    const auto at = [](int i, int n) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(n); };
    return (at(row, shape.chunks()) + static_cast<std::size_t>(index)) * at(planes * grids, shape.tile) +
           at(plane * grids + grid, shape.tile);
  }

  BigArray<std::complex<Real>> cell_;
};

/// A facet with the distance of its planes in wavelengths, and the corrections of the kernels over its pixels.
struct StackedFacet {
  Facet facet;
  double plane_step = 0;
  std::vector<double> h_u;  ///< [column]
  std::vector<double> h_v;  ///< [row]
  SmoothCorrection h_w;     ///< of plane_step · q
};

/// image_i(x, y) += h_u h_v h_w Re Σ_k Σ_{p,q} G_{k,i}(p, q) exp(+2πi(px/nu + qy/nv + w_k q_w(x, y))) for the i-th grid
/// of every plane, w_k = (first_plane + k + ½) plane_step; q_w is the facet's curvature. Pixels beyond the horizon become NaN.
/// What the stack held is lost.
template <typename Real>
void add_stack_to_images(PlaneStack<Real>& stack, const StackedFacet& facet, int first_plane, int threads,
                         const std::vector<Image*>& images);

/// The adjoint, for a stack of one grid a plane: G_k(p, q) = Σ_{x,y} h_u h_v h_w image(x, y) exp(−2πi(px/nu + qy/nv +
/// w_k q_w)), margins filled by periodicity. Pixels beyond the horizon are not used.
template <typename Real>
void image_to_stack(const Image& image, const StackedFacet& facet, int first_plane, int threads, PlaneStack<Real>& stack);

}  // namespace misfit::imager
