#pragma once

#include <cstddef>
#include <vector>

#include "imager/data/image.h"

namespace misfit::imager {

/// The shape of a grid that holds v ≥ 0 only: an image is real, so the other half is its conjugate. Cell (p, q) stands for
/// u = −p/(nu · cell), v = q/(nv · cell), both in wavelengths (columns of the image run against l). A margin around the grid
/// keeps the taps of samples near its edge, so that nothing wraps while gridding; it is folded in before the FFT.
struct GridShape {
  int nu = 0;     ///< length of the FFT along u; even
  int nv = 0;     ///< along v; even
  int width = 0;  ///< of the kernel, in cells
  int tile = 0;   ///< side of a tile, in cells; at least `width`

  int margin() const { return width / 2; }
  int first_column(int p) const { return p + nu / 2 + margin(); }  ///< storage column of cell p
  int first_row(int q) const { return q + margin(); }              ///< storage row of cell q
  int tiles_u() const { return (nu + 2 * margin() + 2) / tile + 1; }
  int tiles_v() const { return (nv / 2 + 2 * margin() + 2) / tile + 1; }
  /// Storage, margins included: room for a whole tile with the taps that leave it.
  int columns() const { return (tiles_u() + 1) * tile; }
  int rows() const { return (tiles_v() + 1) * tile; }
  std::size_t cells() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
};

/// Planes of the grid, kept apart because the loops that fill them work on one at a time. [row][column]
template <typename Real>
struct HalfGrid {
  GridShape shape;
  std::vector<Real> real;
  std::vector<Real> imaginary;

  explicit HalfGrid(const GridShape& grid_shape) : shape(grid_shape), real(grid_shape.cells()), imaginary(grid_shape.cells()) {}
};

/// Corrections h for the columns and rows of an image; see kernels::optimal_correction.
struct ImageCorrection {
  std::vector<double> column;  ///< [width]
  std::vector<double> row;     ///< [height]
};

/// image(x, y) = h(x) h(y) Re Σ_{p,q} G(p, q) exp(+2πi(px/nu + qy/nv)), with x, y counted from the middle pixel.
/// `imaginary` may be empty for a real grid. Only the rows of the grid that hold data and the columns that the image keeps are
/// transformed, in the planes' own memory: std::move them where they are not needed again.
template <typename Real>
Image grid_to_image(const GridShape& shape, std::vector<Real> real, std::vector<Real> imaginary,
                    const ImageCorrection& correction, int threads);

/// Memory of either direction's buffers.
double transform_buffer_bytes(const GridShape& shape, int threads, double real_bytes);

/// The adjoint of grid_to_image(): G(p, q) = Σ_{x,y} h(x) h(y) image(x, y) exp(−2πi(px/nu + qy/nv)), margins filled by
/// periodicity and conjugation.
template <typename Real>
void image_to_grid(const Image& image, const ImageCorrection& correction, int threads, HalfGrid<Real>& grid);

}  // namespace misfit::imager
