#pragma once

#include <memory>

#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// How well a mosaic sees its pixels, and what its images are.
struct MosaicView {
  /// √(W / max W) of the sensitivity W, see AdjointResult: the primary beam of the mosaic. NaN where no beam sees a pixel.
  std::shared_ptr<const Image> primary_beam;
  /// Images are D / (√W √(max W)) of the adjoint D, whose noise is the same everywhere, and models are the sky times the
  /// primary beam; else images are D / W and models the sky.
  bool flat_noise = true;
  int psf_row = 0;  ///< of the pixel whose source the PSF is the response to
  int psf_column = 0;
};

/// How adjoints become images in Jy/beam, and model images what is predicted. That takes a number, Σ w; of a mosaic, whose
/// pixels were seen with unlike beams, it takes the mosaic's primary beam besides.
class Normalisation {
 public:
  /// An image is the adjoint over Σ w, and a model is predicted as it is.
  explicit Normalisation(double weight) : weight_(weight) {}
  /// Of a mosaic, from the sensitivity in each pixel.
  Normalisation(const Image& sensitivity, bool flat_noise, int psf_row, int psf_column);

  /// Makes the image of an adjoint. Returns its statistics.
  ImageStatistics make_image(Image& adjoint) const;
  /// Makes a PSF of the adjoint of what its source gives: the image of a model of 1 in one pixel, which comes to lie in the
  /// middle. Where that moves it, pixels from outside are 0.
  ImageStatistics make_psf(Image& adjoint) const;
  /// Makes what is predicted of a model image. What no beam sees predicts nothing.
  void make_predicted(Image& model) const;
  /// The value of an image, given that of the adjoint.
  double value(int row, int column, double adjoint) const { return adjoint * factor(row, column) / weight_; }

  /// By how much an image's noise is larger than that of the sum of all samples over Σ w, where it is least.
  double noise_factor(double sum_of_weights) const;
  /// Σ w; of a mosaic max W.
  double weight() const { return weight_; }
  /// Null unless it is of a mosaic.
  const MosaicView* mosaic() const { return mosaic_ ? &*mosaic_ : nullptr; }

 private:
  double factor(int row, int column) const;

  double weight_;
  std::shared_ptr<const MosaicView> mosaic_;
};

}  // namespace misfit::imager
