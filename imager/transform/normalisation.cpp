#include "imager/transform/normalisation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::imager {
namespace {

/// The image, moved so that one of its pixels lies in the middle.
Image moved_to_middle(const Image& image, int row, int column) {
  Image moved(image.width, image.height);
  const int down = row - image.height / 2, right = column - image.width / 2;
  for (int r = std::max(0, -down); r < std::min(image.height, image.height - down); ++r)
    for (int c = std::max(0, -right); c < std::min(image.width, image.width - right); ++c)
      moved.at(r, c) = image.at(r + down, c + right);
  return moved;
}

}  // namespace

Normalisation::Normalisation(const Image& sensitivity, bool flat_noise, int psf_row, int psf_column)
    : weight_(std::max(0.0, statistics_of(sensitivity).largest)) {
  auto beam = std::make_shared<Image>(sensitivity);
  for (double& pixel : beam->pixel) pixel = pixel > 0 ? std::sqrt(pixel / weight_) : std::nan("");
  mosaic_ = std::make_shared<const MosaicView>(MosaicView{std::move(beam), flat_noise, psf_row, psf_column});
}

double Normalisation::factor(int row, int column) const {
  if (!mosaic_) return 1;
  const double beam = mosaic_->primary_beam->at(row, column);
  return mosaic_->flat_noise ? 1 / beam : 1 / (beam * beam);
}

ImageStatistics Normalisation::make_image(Image& adjoint) const {
  if (mosaic_)
    for (int row = 0; row < adjoint.height; ++row)
      for (int column = 0; column < adjoint.width; ++column) adjoint.at(row, column) *= factor(row, column);
  return divide(adjoint, weight_);
}

ImageStatistics Normalisation::make_psf(Image& adjoint) const {
  if (!mosaic_ || adjoint.pixel.empty()) return make_image(adjoint);
  const int row = mosaic_->psf_row, column = mosaic_->psf_column;
  make_image(adjoint);
  adjoint = moved_to_middle(adjoint, row, column);
  return divide(adjoint, mosaic_->flat_noise ? mosaic_->primary_beam->at(row, column) : 1);
}

void Normalisation::make_predicted(Image& model) const {
  if (!mosaic_) return;
  for (std::size_t i = 0; i < model.pixel.size(); ++i) {
    const double beam = mosaic_->primary_beam->pixel[i];
    if (std::isnan(beam))
      model.pixel[i] = 0;
    else if (mosaic_->flat_noise)
      model.pixel[i] /= beam;
  }
}

double Normalisation::noise_factor(double sum_of_weights) const {
  return mosaic_ ? std::sqrt(sum_of_weights / weight_) : 1;
}

}  // namespace misfit::imager
