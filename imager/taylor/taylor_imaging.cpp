#include "imager/taylor/taylor_imaging.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "imager/taylor/taylor_prediction.h"
#include "imager/transform/visibility_pass_internal.h"

namespace misfit::imager {
namespace {

/// The images of a sum of dirty images, of which the last `psfs` are PSFs.
std::vector<Image> normalised_images(AdjointResult& result, const ImagedData& imaged, const Context& context, int psfs = 0) {
  const StageTimer timer(context.times, stage::fft);
  const std::size_t first_psf = result.images.size() - static_cast<std::size_t>(psfs);
  for (std::size_t i = 0; i < result.images.size(); ++i) {
    if (i < first_psf)
      imaged.normalisation.make_image(result.images[i]);
    else
      imaged.normalisation.make_psf(result.images[i]);
  }
  return std::move(result.images);
}

std::vector<Image> normalised_images(std::unique_ptr<AdjointSum> sum, const ImagedData& imaged, const Context& context,
                                     int psfs = 0) {
  AdjointResult result = finish_adjoint(std::move(sum), imaged.samples.source.ranks(), context);
  return normalised_images(result, imaged, context, psfs);
}

/// The sensitivities of powers over the first sensitivity.
std::vector<Image> relative_peaks(AdjointResult& result) {
  for (Image& further : result.further_sensitivity)
    for (std::size_t i = 0; i < further.pixel.size(); ++i) further.pixel[i] /= result.sensitivity.pixel[i];
  return std::move(result.further_sensitivity);
}

}  // namespace

TaylorImages make_taylor_images(const ImagedData& imaged, const Transform& psf, const TaylorExpansion& expansion,
                                const Context& context) {
  const TaylorPowers of_dirty{1, expansion.terms - 1}, of_psf{1, 2 * expansion.terms - 2};
  const bool together = &imaged.transform == &psf && of_dirty.last + of_psf.last <= most_stokes;
  VisibilityPass pass(imaged.samples.source, context);
  auto sum = begin_adjoint(imaged.transform,
                           {.images = of_dirty.last + (together ? of_psf.last : 0),
                            .with_sensitivity = true,
                            .sensitivity_powers = of_psf.last,
                            .sensitivity_reference_hz = expansion.reference_hz},
                           context);
  auto psf_sum = together ? nullptr : begin_adjoint(psf, {.images = of_psf.last}, context);
  pass.for_each_block([&](const VisibilityBlock& block) {
    const StageTimer timer(context.times, stage::grid);
    const std::complex<float>* const data = block.visibility_of(imaged.samples.index);
    auto dirty_sets = taylor_sets(expansion, block, {data, data + block.samples()}, of_dirty);
    auto psf_sets = taylor_sets(expansion, block, psf.psf_source(block), of_psf);
    if (together)
      std::move(psf_sets.begin(), psf_sets.end(), std::back_inserter(dirty_sets));
    else
      psf_sum->add(block, psf_sets);
    sum->add(block, dirty_sets);
  });
  TaylorImages images;
  if (psf_sum) images.psf = normalised_images(std::move(psf_sum), imaged, context, of_psf.last);
  AdjointResult result = finish_adjoint(std::move(sum), imaged.samples.source.ranks(), context);
  images.dirty = normalised_images(result, imaged, context, together ? of_psf.last : 0);
  images.relative_peaks = relative_peaks(result);
  const MosaicView* const mosaic = imaged.normalisation.mosaic();
  if (mosaic != nullptr && !mosaic->flat_noise) images.divided_by = mosaic->primary_beam;
  if (together && !images.dirty.empty()) {
    const auto first_psf = images.dirty.begin() + of_dirty.last;
    std::move(first_psf, images.dirty.end(), std::back_inserter(images.psf));
    images.dirty.erase(first_psf, images.dirty.end());
  }
  return images;
}

std::vector<Image> make_taylor_residuals(const ImagedData& imaged, std::vector<Image> models, const TaylorExpansion& expansion,
                                         const Context& context) {
  if (expansion.terms == 1) {
    std::vector<Image> residual;
    residual.push_back(make_residual_image(imaged, std::move(models.front()), context));
    return residual;
  }
  for (Image& model : models) imaged.normalisation.make_predicted(model);
  auto sum = begin_adjoint(imaged.transform, {.images = expansion.terms}, context);
  const TaylorPowers powers{0, expansion.terms - 1};
  for_each_residual(
      imaged.samples, [&] { return std::make_unique<TaylorPrediction>(imaged.transform, std::move(models), expansion); },
      context,
      [&](const VisibilityBlock& block, const std::vector<std::complex<double>>& residual) {
        const StageTimer timer(context.times, stage::grid);
        sum->add(block, taylor_sets(expansion, block, residual, powers));
      });
  return normalised_images(std::move(sum), imaged, context);
}

}  // namespace misfit::imager
