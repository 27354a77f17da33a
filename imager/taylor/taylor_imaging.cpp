#include "imager/taylor/taylor_imaging.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "imager/data/phase.h"
#include "imager/numerics/phasors.h"
#include "imager/taylor/taylor_prediction.h"
#include "imager/transform/visibility_pass_internal.h"

namespace misfit::imager {
namespace {

std::vector<Image> normalised_images(std::unique_ptr<AdjointSum> sum, const ImagedData& imaged, const Context& context) {
  AdjointResult result = finish_adjoint(std::move(sum), imaged.samples.source.ranks(), context);
  const StageTimer timer(context.times, stage::fft);
  for (Image& image : result.images) imaged.normalisation.make_image(image);
  return std::move(result.images);
}

/// Those of a source of 1 Jy at the image's middle pixel. [row][channel]
std::vector<std::complex<double>> visibilities_of_middle(const VisibilityBlock& block, const TaylorPsf& psf) {
  std::vector<std::complex<double>> visibility(block.samples(), 1);
  if (psf.middle.l == 0 && psf.middle.m == 0) return visibility;
  PhasePosition at = phase_position(psf.middle);
  if (!psf.with_w) at.n_minus_1 = 0;
  std::vector<double> turns(block.channels()), cosine(block.channels()), sine(block.channels());
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const double per_hz = turns_per_hz(&block.uvw_m[3 * row], at);
    for (std::size_t c = 0; c < turns.size(); ++c) turns[c] = per_hz * block.frequency_hz[c];
    phasors(turns.data(), static_cast<int>(turns.size()), cosine.data(), sine.data());
    for (std::size_t c = 0; c < turns.size(); ++c) visibility[row * turns.size() + c] = {cosine[c], sine[c]};
  }
  return visibility;
}

}  // namespace

TaylorImages make_taylor_images(const ImagedData& imaged, const TaylorPsf& psf, const TaylorExpansion& expansion,
                                const Context& context) {
  const TaylorPowers of_dirty{1, expansion.terms - 1}, of_psf{1, 2 * expansion.terms - 2};
  const bool together = &imaged.transform == &psf.transform && of_dirty.last + of_psf.last <= most_stokes;
  VisibilityPass pass(imaged.samples.source, context);
  auto sum = begin_adjoint(imaged.transform, {.images = of_dirty.last + (together ? of_psf.last : 0)}, context);
  auto psf_sum = together ? nullptr : begin_adjoint(psf.transform, {.images = of_psf.last}, context);
  pass.for_each_block([&](const VisibilityBlock& block) {
    const StageTimer timer(context.times, stage::grid);
    const std::complex<float>* const data = block.visibility_of(imaged.samples.index);
    auto dirty_sets = taylor_sets(expansion, block, {data, data + block.samples()}, of_dirty);
    auto psf_sets = taylor_sets(expansion, block, visibilities_of_middle(block, psf), of_psf);
    if (together)
      std::move(psf_sets.begin(), psf_sets.end(), std::back_inserter(dirty_sets));
    else
      psf_sum->add(block, psf_sets);
    sum->add(block, dirty_sets);
  });
  TaylorImages images;
  if (psf_sum) images.psf = normalised_images(std::move(psf_sum), imaged, context);
  images.dirty = normalised_images(std::move(sum), imaged, context);
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
