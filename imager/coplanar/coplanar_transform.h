#pragma once

#include <optional>

#include "imager/data/geometry.h"
#include "imager/transform/transform.h"
#include "kernels/kernel.h"
#include "kernels/lookup_table.h"
#include "kernels/precision.h"

namespace misfit::imager {

using kernels::Precision;

/// The options of a CoplanarTransform. Both kernels have one width, and x0 at least image size / (2 · FFT size) on their axis.
struct CoplanarOptions {
  ImageGeometry geometry;
  int nu = 0;  ///< FFT lengths, even, at least the image's size
  int nv = 0;
  kernels::Kernel kernel_u;
  kernels::Kernel kernel_v;
  Precision precision = Precision::double_precision;  ///< of taps, grid and FFT; coordinates are always double
  int threads = 1;
  std::optional<kernels::TableOptions> lookup{};  ///< taps come from tables of the kernels' polynomials
};

/// The transform in two dimensions by gridding and FFT, about any centre: w(n−1) is taken as 0. Forward and adjoint are exact
/// transposes of each other, and the result does not depend on the number of threads. Throws std::invalid_argument when the
/// options contradict each other.
std::unique_ptr<Transform> make_coplanar_transform(const CoplanarOptions& options);

/// Memory that a transform takes, in bytes. Grids count with the sums in double precision of their crowded tiles.
struct TransformMemory {
  double visibilities = 0;  ///< grid of an adjoint without PSF, or of a prediction
  double psf = 0;           ///< grid that the PSF adds to an adjoint
  double fft = 0;           ///< buffers
  double other_stokes = 0;  ///< grids that further Stokes parameters add to an adjoint
  double gathered = 0;      ///< samples whose blocks a prediction holds at once; 0: of one block
};

/// The memory of an adjoint of `stokes` images from so many samples.
TransformMemory memory_of(const CoplanarOptions& options, int stokes = 1, double samples = 0);

/// The number of additions, one after another, to a cell of the grid where all samples lie in one cell: rounding can add up
/// this often. Additions in double precision do not count where the others are in single.
double longest_plane_sum(Precision precision, double samples);

}  // namespace misfit::imager
