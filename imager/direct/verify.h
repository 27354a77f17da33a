#pragma once

#include "imager/direct/direct_transform.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// `count` pixels above the horizon at random, always the same; fewer where hardly any are above it, and each pixel once where
/// the image has no more than `count`.
std::vector<Pixel> random_pixels(const ImageGeometry& geometry, int count);

/// How far an image is from direct sums at some of its pixels, in Jy/beam.
struct PixelError {
  double rms = 0;
  double max = 0;
};

/// The error of a dirty image, given Σ w Re[…] at the pixels.
PixelError pixel_error(const Image& dirty, const std::vector<Pixel>& pixels, const std::vector<double>& direct_sums,
                       const Normalisation& by);

/// The error over the RMS of the whole dirty image; 0 for an image of zeros that is exact.
PixelError relative_pixel_error(const PixelError& error, const Image& dirty);

/// Measured differences from the direct transform, w included.
struct MeasuredError {
  std::vector<PixelError> image;  ///< [Stokes]: of the dirty image at random pixels, over its RMS
  double predict_rms = 0;         ///< of prediction at random samples, over the RMS of the predicted visibilities
};

/// Compares the dirty images with direct sums at `count` random pixels, and predicted visibilities with direct sums at `count`
/// random samples of each rank, for a model of the same pixels; with all pixels where there are no more, and fewer samples
/// where there are fewer. The choice depends on `count` alone. A mosaic's samples have a response.
MeasuredError measure_error(const VisibilitySource& source, const Transform& transform, const ImageGeometry& geometry,
                            const DirtyImages& images, int count, const Context& context,
                            std::shared_ptr<const SampleResponse> response = nullptr);

}  // namespace misfit::imager
