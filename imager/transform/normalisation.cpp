#include "imager/transform/normalisation.h"

namespace misfit::imager {
namespace {

void multiply(Image& image, const Image& factor) {
  for (std::size_t i = 0; i < image.pixel.size(); ++i) image.pixel[i] *= factor.pixel[i];
}

}  // namespace

ImageStatistics Normalisation::make_image(Image& adjoint) const {
  if (of_adjoint_) multiply(adjoint, *of_adjoint_);
  return divide(adjoint, weight_);
}

void Normalisation::make_predicted(Image& model) const {
  if (of_model_) multiply(model, *of_model_);
}

}  // namespace misfit::imager
