#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/image.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {

/// Pixels of an image that stand for true.
struct Region {
  int width = 0;
  int height = 0;
  std::vector<char> in;  ///< [height][width]

  /// The pixels where of(pixel) is true.
  template <typename Of>
  Region(const Image& image, int threads, const Of& of) : width(image.width), height(image.height), in(image.pixel.size()) {
    parallel_for(static_cast<std::size_t>(height), threads, [&](std::size_t r) {
      const double* const row = image.row(static_cast<int>(r));
      std::transform(row, row + width, in.data() + r * static_cast<std::size_t>(width), of);
    });
  }

  bool empty() const { return std::find(in.begin(), in.end(), 1) == in.end(); }

  /// Calls visit(place) for the up to four neighbours of a place.
  template <typename Visit>
  void for_each_neighbour(std::size_t place, const Visit& visit) const {
    const auto columns = static_cast<std::size_t>(width);
    if (place >= columns) visit(place - columns);
    if (place + columns < in.size()) visit(place + columns);
    if (place % columns != 0) visit(place - 1);
    if (place % columns + 1 != columns) visit(place + 1);
  }
};

/// How a region is smoothed.
struct RegionSmoothing {
  Beam beam;
  double cell_rad = 0;  ///< pixel size
  double cut = 0;       ///< part of the largest value
  int threads = 1;
};

/// Replaces a region R by the pixels where R ⊗ beam exceeds `cut` times its largest value. Pixels of R count 1, and the beam,
/// whose peak is 1, is convolve_with_beam()'s. An empty region stays so.
void smooth_and_cut(const RegionSmoothing& by, Region& region);

}  // namespace misfit::imager
