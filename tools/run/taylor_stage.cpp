#include "tools/run/taylor_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::tools {
void TaylorStage::make_images(const imager::ImagedData& imaged, const imager::AccurateImages& made, TakenTerms taken,
                              const imager::Context& context) {
  const imager::TakenImages& which = taken.which;
  std::optional<imager::ComparedPixels> pixels;
  if (which.any()) pixels.emplace(made.plan, imaged.transform);
  images_ =
      imager::make_taylor_images({imaged.samples, which.dirty ? pixels->transform() : imaged.transform, imaged.normalisation},
                                 which.psf ? pixels->transform() : made.transform->psf(), expansion_, context);
  if (!imaged.samples.source.ranks().first()) return;  // where the images are
  if (pixels) take(std::move(taken), *pixels, made);
  psf_ = all_terms(made.images.psf, images_.psf);
  basis_ = imager::basis_of(psf_);
}

/// Replaces compared pixels by the images that are taken. An image of x^k has the errors of an image of |x|^k.
void TaylorStage::take(TakenTerms taken, const imager::ComparedPixels& pixels, const imager::AccurateImages& made) {
  const imager::GriddingRequest& request = made.plan.request;
  const auto middle = [](const imager::Image& image) { return image.at(image.height / 2, image.width / 2); };
  const std::vector<imager::Image>& powers = taken.which.psf ? taken.images.psf : images_.psf;
  x_rms_ = std::sqrt(std::abs(middle(powers.at(1)) / middle(made.images.psf)));
  const auto compare = [&](const imager::Image& first, const std::vector<imager::Image>& images,
                           const std::vector<imager::Image>& values, double accuracy, bool psf) {
    for (std::size_t k = 0; k < images.size(); ++k) {
      const double rms = std::max(root_mean_square(images[k]), distance_rms(k + 1) * root_mean_square(first));
      pixels.require(images[k], values[k], rms, accuracy, {psf, 0, static_cast<int>(k) + 1});
    }
  };
  if (taken.which.psf) {
    compare(made.images.psf, taken.images.psf, images_.psf, request.psf_accuracy, true);
    images_.psf = std::move(taken.images.psf);
  }
  if (!taken.which.dirty) return;
  if (!taken.which.of_model) compare(made.images.dirty.front(), taken.images.dirty, images_.dirty, request.accuracy, false);
  images_.dirty = std::move(taken.images.dirty);
}

double TaylorStage::distance_rms(std::size_t power) const {
  return std::pow(x_rms_, static_cast<double>(power));
}

std::vector<imager::Image> TaylorStage::principal_solution(const imager::Image& dirty) const {
  return principal_solution(all_terms(dirty, images_.dirty));
}

std::vector<imager::Image> TaylorStage::principal_solution(const std::vector<const imager::Image*>& residual) const {
  if (!images_.relative_peaks.empty()) return imager::principal_solution(images_.relative_peaks, residual, threads_);
  return imager::principal_solution(*basis_, residual, threads_);
}

RestoredTerms TaylorStage::restore(const imager::CleanResult& cleaned, const imager::Beam& beam, double cell_rad) const {
  const std::vector<imager::Image> left = principal_solution(cleaned.residuals());
  std::vector<imager::Image> images;
  for (const imager::Image* model : cleaned.models())
    images.push_back(imager::restored({*model, left[images.size()]}, beam, cell_rad, threads_));
  RestoredTerms terms;
  std::optional<imager::SolutionNoise> noise;
  if (!images_.relative_peaks.empty())
    noise = imager::solution_noise(images_.relative_peaks, images_.divided_by.get(), threads_);
  terms.spectra = imager::spectral_images(images, left, threads_, noise);
  terms.first = std::move(images.front());
  for (std::size_t t = 1; t < images.size(); ++t) terms.further.push_back(std::move(images[t]));
  return terms;
}

}  // namespace misfit::tools
