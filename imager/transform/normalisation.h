#pragma once

#include <memory>

#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// The sensitivity of a mosaic in its pixels, and the definition of its images.
struct MosaicView {
  /// √(W / max W) of the sensitivity W, see AdjointResult: the primary beam of the mosaic. NaN where no beam sees a pixel.
  std::shared_ptr<const Image> primary_beam;
  /// If true, images are D / (√W √(max W)) of the adjoint D, with the same noise everywhere, and models are the sky times the
  /// primary beam; else images are D / W and models the sky.
  bool flat_noise = true;
  int psf_row = 0;  ///< of the pixel whose source the PSF is the response to
  int psf_column = 0;
};

/// How adjoints become images in Jy/beam, and how model images become images to predict. That takes a number, Σ w; for a
/// mosaic, whose pixels were seen with unlike beams, it also takes the mosaic's primary beam.
class Normalisation {
 public:
  /// An image is the adjoint over Σ w, and a model is predicted as it is.
  explicit Normalisation(double weight) : weight_(weight) {}
  /// The normalisation of a mosaic, from the sensitivity in each pixel.
  Normalisation(const Image& sensitivity, bool flat_noise, int psf_row, int psf_column);

  /// Makes the image of an adjoint. Returns its statistics.
  ImageStatistics make_image(Image& adjoint) const;
  /// Makes a PSF of the adjoint of its source's visibilities: the image of a model of 1 in one pixel, which comes to lie in the
  /// middle. Where that moves it, pixels from outside are 0.
  ImageStatistics make_psf(Image& adjoint) const;
  /// Makes the image to predict of a model image. It is 0 where no beam sees.
  void make_predicted(Image& model) const;
  /// The value of a pixel of an image, given the adjoint's.
  double value(int row, int column, double adjoint) const { return adjoint * factor(row, column) / weight_; }

  /// An image's noise, where it is least, over the noise of the sum of all samples over Σ w.
  double noise_factor(double sum_of_weights) const;
  /// Σ w; max W for a mosaic.
  double weight() const { return weight_; }
  /// Null unless this is the normalisation of a mosaic.
  const MosaicView* mosaic() const { return mosaic_ ? &*mosaic_ : nullptr; }

 private:
  double factor(int row, int column) const;

  double weight_;
  std::shared_ptr<const MosaicView> mosaic_;
};

}  // namespace misfit::imager
