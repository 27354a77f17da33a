#pragma once

#include <cstddef>

#include "imager/coplanar/half_grid.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// The part of the uv plane that lies between the two transforms: rows of the grid, columns of the image. [q][column]
/// It is kept in the planes of the grid, each row in place of row q of the grid, which nothing else needs.
template <typename Real>
struct KeptColumns {
  const GridShape& shape;
  Real* real_plane;
  Real* imaginary_plane;

  Real* real(int q) const { return real_plane + row(q); }
  Real* imaginary(int q) const { return imaginary_plane + row(q); }

 private:
  std::size_t row(int q) const {
    return static_cast<std::size_t>(shape.first_row(q)) * static_cast<std::size_t>(shape.columns());
  }
};

/// Columns of an image, counted from the middle one.
struct ColumnRange {
  int first;
  int count;
};

/// The image of kept columns: transforms them along v, some at a time so that memory is read in lines, and multiplies by h. An
/// even image has its other columns by symmetry.
template <typename Real>
Image transform_columns(const KeptColumns<Real>& kept, ColumnRange columns, bool even, const ImageCorrection& h, int threads);

/// The transpose: kept columns of h times an image, all of its columns.
template <typename Real>
void transform_image_columns(const Image& image, const ImageCorrection& h, int threads, const KeptColumns<Real>& kept);

}  // namespace misfit::imager
