#pragma once

#include <memory>
#include <utility>

#include "imager/data/image_statistics.h"

namespace misfit::imager {

/// How adjoints become images in Jy/beam, and model images what is predicted. That takes a number, Σ w. A mosaic, whose pixels
/// were seen with unlike beams, takes images of factors besides.
class Normalisation {
 public:
  /// An image is the adjoint over Σ w, and a model is predicted as it is.
  explicit Normalisation(double weight) : weight_(weight) {}
  /// An image is `of_adjoint` × adjoint / Σ w, and `of_model` × model is predicted, pixel by pixel; a null image is 1
  /// everywhere. With the same image twice prediction and images stay each other's adjoints.
  Normalisation(double weight, std::shared_ptr<const Image> of_adjoint, std::shared_ptr<const Image> of_model)
      : weight_(weight), of_adjoint_(std::move(of_adjoint)), of_model_(std::move(of_model)) {}

  /// Makes the image of an adjoint. Returns its statistics.
  ImageStatistics make_image(Image& adjoint) const;
  /// Makes what is predicted of a model image.
  void make_predicted(Image& model) const;

 private:
  double weight_;
  std::shared_ptr<const Image> of_adjoint_;  ///< null = 1
  std::shared_ptr<const Image> of_model_;    ///< null = 1
};

}  // namespace misfit::imager
