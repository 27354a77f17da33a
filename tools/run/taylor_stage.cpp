#include "tools/run/taylor_stage.h"

namespace misfit::tools {
namespace {

imager::TaylorPsf psf_of(const imager::AccurateImages& made) {
  const imager::GriddingPlan& plan = made.plan;
  const bool with_w = plan.direct || (plan.psf ? *plan.psf : plan).options.has_w_axis();
  return {made.transform->psf(), plan.options.geometry.centre, with_w};
}

/// Of the first term and the further ones.
std::vector<const imager::Image*> all_terms(const imager::Image& first, const std::vector<imager::Image>& further) {
  std::vector<const imager::Image*> terms{&first};
  for (const imager::Image& image : further) terms.push_back(&image);
  return terms;
}

}  // namespace

void TaylorStage::make_images(const imager::ImagedData& imaged, const imager::AccurateImages& made, TakenTerms taken,
                              const imager::Context& context) {
  if (!taken.dirty || !taken.psf) images_ = imager::make_taylor_images(imaged, psf_of(made), expansion_, context);
  if (taken.dirty) images_.dirty = std::move(*taken.dirty);
  if (taken.psf) images_.psf = std::move(*taken.psf);
  if (!imaged.samples.source.ranks().first()) return;  // where the images are
  psf_ = all_terms(made.images.psf, images_.psf);
  basis_ = imager::basis_of(psf_);
}

std::vector<imager::Image> TaylorStage::principal_solution(const imager::Image& dirty) const {
  return imager::principal_solution(*basis_, all_terms(dirty, images_.dirty), threads_);
}

RestoredTerms TaylorStage::restore(const imager::CleanResult& cleaned, const imager::Beam& beam, double cell_rad) const {
  const std::vector<imager::Image> left =
      imager::principal_solution(*basis_, all_terms(cleaned.residual, cleaned.further_residuals), threads_);
  std::vector<imager::Image> images;
  for (const imager::Image* model : all_terms(cleaned.model, cleaned.further_models))
    images.push_back(imager::restored({*model, left[images.size()]}, beam, cell_rad, threads_));
  RestoredTerms terms;
  terms.spectra = imager::spectral_images(images, left, threads_);
  terms.first = std::move(images.front());
  for (std::size_t t = 1; t < images.size(); ++t) terms.further.push_back(std::move(images[t]));
  return terms;
}

}  // namespace misfit::tools
