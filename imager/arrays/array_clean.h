#pragma once

#include "imager/arrays/array_transform.h"
#include "imager/beams/beam.h"
#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"

namespace misfit::imager {

struct ArrayCleanOptions {
  ArrayTransformOptions transform;    ///< pixels are square, and not divided by n
  CleanOptions clean;                 ///< in the threads of `transform`
  DeconvolverChoice deconvolver;      ///< in the threads of `transform`
  Strided<const double> start_model;  ///< [x][y], Jy/pixel, of points; none: CLEAN begins without a model
};

/// Images [x][y] of a CLEAN run; NaN beyond the horizon.
struct ArrayClean {
  Image restored;  ///< Jy/beam
  Image residual;
  Image psf;    ///< 1 at the pixel in the middle
  Image model;  ///< Jy/pixel
  Image mask;   ///< made by CleanOptions::automask; empty without
  Beam beam;    ///< its position angle counts from the axis of x towards that of y
  SampleSums sums;
  CleanReport report;
  double expected_error = 0;  ///< of the dirty image, RMS over its RMS
};

/// Cotton–Schwab CLEAN of visibilities in arrays: dirty image and PSF over the sum of the weights, see make_accurate_images and
/// clean(). Samples beyond 1/(2 pixel) are left out, as in imaging. Visibilities are cleaned in single precision. Throws
/// std::invalid_argument as ArrayTransform does, where pixels are not square, a weight is negative, or a value that counts is
/// not finite; std::runtime_error where no sample can be used, or no beam fits the PSF.
template <typename Real>
ArrayClean clean_arrays(const ArrayCleanOptions& options, const ArrayCoordinates& at, const ArrayValues<Real>& values);

}  // namespace misfit::imager
