#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/numerics/big_array.h"

namespace misfit::imager {

inline constexpr int columns_at_once = 16;  ///< columns that are transformed along v together: a cache line or two of each row

/// Rows 0 … nv/2 of half planes between their FFTs along u and along v, of the columns that the image keeps. The memory of one
/// group of columns lies together: [group][plane][grid][q][column in group]. Memory is used again from one facet to the next.
template <typename Real>
class ImagePlanes {
 public:
  ImagePlanes(int fft_length_v, int grid_count)
      : nv(fft_length_v), grids(grid_count), holds(static_cast<std::size_t>(fft_length_v / 2 + 1)) {}

  /// Makes room for that many columns and planes; no row holds anything.
  void reserve(int column_count, int plane_count) {
    width = column_count;
    planes = plane_count;
    value_.reserve(offset((width + columns_at_once - 1) / columns_at_once, 0, 0, 0));
    holds.assign(holds.size(), 0);
  }
  int rows() const { return nv / 2 + 1; }
  int opposite(int plane) const { return planes - 1 - plane; }

  /// Row q of a group: columns_at_once values, after which follows row q + 1.
  std::complex<Real>* row(int group, int plane, int grid, int q) { return value_.data() + offset(group, plane, grid, q); }
  const std::complex<Real>* row(int group, int plane, int grid, int q) const {
    return value_.data() + offset(group, plane, grid, q);
  }

  int nv;  ///< length of the FFT along v
  int width = 0;
  int planes = 0;
  int grids;
  std::vector<char> holds;  ///< [q]: whether anything; the content of other rows is undefined

 private:
  std::size_t offset(int group, int plane, int grid, int q) const {
    const auto at = [](int i, int n) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(n); };
    return (at(group, planes * grids) + at(plane, grids) + static_cast<std::size_t>(grid)) * at(rows(), columns_at_once) +
           at(q, columns_at_once);
  }

  BigArray<std::complex<Real>> value_;
};

}  // namespace misfit::imager
