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

/// Some neighbouring planes of constant w, each with one or more complex grids whose real and imaginary parts are components in
/// turn. What a tile holds of one row lies together: [row][chunk][plane][component][column in chunk], a chunk being as wide as
/// a tile. Memory is used again from one facet to the next.
template <typename Real>
class PlaneStack {
 public:
  PlaneStack(const StackShape& stack_shape, int component_count) : shape(stack_shape), components(component_count) {}

  /// Makes room for that many planes, whose content is undefined.
  void reserve(int plane_count);
  /// Makes all planes zero.
  void clear(int threads);

  Real* chunk(int row, int index, int plane, int component) { return cell_.data() + offset(row, index, plane, component); }
  const Real* chunk(int row, int index, int plane, int component) const {
    return cell_.data() + offset(row, index, plane, component);
  }

  StackShape shape;
  int planes = 0;
  int components = 2;
  std::vector<char> row_used;            ///< [row]: whether any plane may hold something there
  BigArray<std::complex<Real>> between;  ///< what lies between the two transforms of an FFT

 private:
  std::size_t offset(int row, int index, int plane, int component) const {
    const auto at = [](int i, int n) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(n); };
    return (at(row, shape.chunks()) + static_cast<std::size_t>(index)) * at(planes * components, shape.tile) +
           at(plane * components + component, shape.tile);
  }

  BigArray<Real> cell_;
};

/// Bytes that a stack takes for each plane, whose FFTs keep `width` columns of an image.
template <typename Real>
double bytes_a_plane(const StackShape& shape, int components, int width);

/// A facet with the distance of its planes in wavelengths, and the corrections of the kernels over its pixels.
struct StackedFacet {
  Facet facet;
  double plane_step = 0;
  std::vector<double> h_u;  ///< [column]
  std::vector<double> h_v;  ///< [row]
  SmoothCorrection h_w;     ///< of plane_step · q
};

/// image_i(x, y) += h_u h_v h_w Re Σ_k Σ_{p,q} G_{k,i}(p, q) exp(+2πi(px/nu + qy/nv + w_k q_w(x, y))) for the i-th complex grid
/// of every plane, w_k = (first_plane + k + ½) plane_step; q_w is the facet's curvature. Pixels beyond the horizon become NaN.
template <typename Real>
void add_stack_to_images(PlaneStack<Real>& stack, const StackedFacet& facet, int first_plane, int threads,
                         const std::vector<Image*>& images);

/// The adjoint, for a stack of one complex grid a plane: G_k(p, q) = Σ_{x,y} h_u h_v h_w image(x, y) exp(−2πi(px/nu + qy/nv +
/// w_k q_w)), margins filled by periodicity. Pixels beyond the horizon are not used.
template <typename Real>
void image_to_stack(const Image& image, const StackedFacet& facet, int first_plane, int threads, PlaneStack<Real>& stack);

}  // namespace misfit::imager
