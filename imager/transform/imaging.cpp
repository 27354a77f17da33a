#include "imager/transform/imaging.h"

#include <stdexcept>
#include <utility>

#include "imager/transform/visibility_pass_internal.h"

namespace misfit::imager {
namespace {

/// Data − model. [block][row][channel]
std::vector<std::vector<std::complex<double>>> residuals(const Prediction& prediction, const VisibilityPass::Blocks& blocks,
                                                         std::size_t stokes) {
  std::vector<const VisibilityBlock*> plain;
  for (const auto& block : blocks) plain.push_back(block.get());
  auto residual = prediction.at_usable_of(plain);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::complex<float>* const data = blocks[b]->visibility_of(stokes);
    for (std::size_t i = 0; i < residual[b].size(); ++i) residual[b][i] = std::complex<double>(data[i]) - residual[b][i];
  }
  return residual;
}

void require_any(const SampleSums& sums) {
  if (sums.weight != 0) return;
  if (sums.outside_grid == 0)
    throw std::runtime_error("no visibility can be imaged: all weights are 0; expected at least one above 0");
  throw NothingInGrid(sums.outside_grid);
}

DirtyImages dirty_images(const Transform& transform, AdjointResult sum, Image psf, const Ranks& ranks, const Context& context) {
  require_any(sum.sums.front());
  const StageTimer timer(context.times, stage::fft);
  const Normalisation by = transform.normalisation(sum);
  DirtyImages made{std::move(sum.images), std::move(psf), std::move(sum.sums), {}, {}, by};
  for (Image& image : made.dirty) {
    made.dirty_statistics.push_back(by.make_image(image));
    share_values(ranks, made.dirty_statistics.back());
  }
  made.psf_statistics = by.make_psf(made.psf);
  share_values(ranks, made.psf_statistics);
  return made;
}

}  // namespace

NothingInGrid::NothingInGrid(std::uint64_t samples)
    : std::runtime_error("no visibility can be imaged: all " + std::to_string(samples) +
                         " usable samples lie beyond 1/(2 cell) in the uv plane; expected smaller pixels"),
      outside_grid(samples) {}

DirtyImages make_dirty_images(const VisibilitySource& source, const Transform& transform, const AdjointOptions& options,
                              const Context& context) {
  VisibilityPass pass(source, context);
  AdjointOptions all = options;
  all.with_sensitivity = true;
  auto sum = begin_adjoint(transform, all, context);
  pass.for_each_block([&](const VisibilityBlock& block) {
    const StageTimer timer(context.times, stage::grid);
    sum->add(block);
  });
  AdjointResult result = finish_adjoint(std::move(sum), source.ranks(), context);
  Image psf = std::move(result.psf);
  return dirty_images(transform, std::move(result), std::move(psf), source.ranks(), context);
}

DirtyImages make_dirty_images(const VisibilitySource& source, const Transform& transform, const OwnPsf& psf,
                              const Context& context) {
  VisibilityPass pass(source, context);
  auto sum = begin_adjoint(transform, {.images = psf.images, .with_sensitivity = true}, context);
  auto psf_sum = begin_adjoint(psf.transform, {.images = 0, .with_psf = true}, context);
  pass.for_each_block([&](const VisibilityBlock& block) {
    const StageTimer timer(context.times, stage::grid);
    sum->add(block);
    psf_sum->add(block);
  });
  AdjointResult of_psf = finish_adjoint(std::move(psf_sum), source.ranks(), context);
  AdjointResult result = finish_adjoint(std::move(sum), source.ranks(), context);
  return dirty_images(transform, std::move(result), std::move(of_psf.psf), source.ranks(), context);
}

void for_each_residual(const OneStokes& samples, const MakePrediction& predict, const Context& context,
                       const VisitResidual& visit) {
  VisibilityPass pass(samples.source, context);
  std::unique_ptr<Prediction> prediction;
  {
    const StageTimer timer(context.times, stage::degrid);
    prediction = predict();
  }
  pass.for_each_group(prediction->samples_at_once(), [&](const VisibilityPass::Blocks& blocks) {
    std::vector<std::vector<std::complex<double>>> residual;
    {
      const StageTimer timer(context.times, stage::degrid);
      residual = residuals(*prediction, blocks, samples.index);
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) visit(*blocks[b], residual[b]);
  });
  context.move_seconds(stage::degrid, stage::fft, prediction->fft_s());
}

void for_each_residual(const OneStokes& samples, const Transform& transform, Image model, const Context& context,
                       const VisitResidual& visit) {
  for_each_residual(
      samples, [&] { return transform.predict(std::move(model)); }, context, visit);
}

Image make_residual_image(const ImagedData& imaged, Image model, const Context& context) {
  auto sum = begin_adjoint(imaged.transform, {}, context);
  imaged.normalisation.make_predicted(model);
  for_each_residual(imaged.samples, imaged.transform, std::move(model), context,
                    [&](const VisibilityBlock& block, const std::vector<std::complex<double>>& residual) {
                      const StageTimer timer(context.times, stage::grid);
                      sum->add(block, residual);
                    });
  AdjointResult result = finish_adjoint(std::move(sum), imaged.samples.source.ranks(), context);
  imaged.normalisation.make_image(result.images.front());
  return std::move(result.images.front());
}

}  // namespace misfit::imager
