#include "tools/run/plane_run.h"

#include <algorithm>
#include <optional>

#include "imager/clean/shared_model.h"
#include "imager/direct/verify.h"
#include "tools/base/interrupt.h"
#include "tools/run/beam_choice.h"
#include "tools/run/run_messages.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {

imager::Context PlaneScene::context() const {
  const auto update = [this](std::uint64_t done, std::uint64_t total) {
    if (given_up && given_up()) throw Interrupted();
    progress.update(done, total);
  };
  return {threads, &times, update};
}

PlaneRun::PlaneRun(const PlaneScene& scene, imager::StreamedVisibilities& source, std::string name)
    : scene_(scene), source_(source), name_(std::move(name)) {
  report_.stokes.clear();
  for (const imager::Stokes stokes : scene_.stokes) report_.stokes.push_back({.stokes = stokes});
}

void PlaneRun::weigh() {
  const imager::WeightingOptions options = weighting_options(scene_.options);
  if (options.none()) return;
  scene_.progress.begin("weights" + name_);
  weigh(imager::make_imaging_weights(source_, options, scene_.geometry, scene_.context()));
  scene_.progress.end();
}

void PlaneRun::weigh(std::shared_ptr<const imager::ImagingWeights> weights) {
  const imager::StageTimer timer(scene_.times, "weights");
  weights_ = std::move(weights);
  source_.apply(weights_, scene_.threads);
}

void PlaneRun::make_dirty(imager::GriddingPlan plan, std::shared_ptr<const imager::PlannedTransform> transform) {
  scene_.progress.begin("dirty image and PSF" + name_);
  made_ = imager::make_accurate_images(source_, std::move(plan), scene_.context(), std::move(transform));
  scene_.progress.end();
  report_.sums = made_.images.sums.front();
  report_.made_twice = made_.plan.request.accuracy != scene_.options.accuracy;  // a second pass asks for more
  predict_noise();
  const imager::StageTimer timer(scene_.times, "statistics");
  const imager::NeglectedPhase phase = imager::neglected_w_phase(scene_.reach, source_.w_spread(), scene_.geometry);
  double expected = 0;
  for (std::size_t s = 0; s < scene_.stokes.size(); ++s) {
    const double rms = made_.images.dirty_statistics[s].root_mean_square();
    report_.stokes[s].theory = imager::theoretical_error(made_.plan, made_.images.sums[s], rms, phase);
    expected = std::max(expected, report_.stokes[s].theory->expected_rms);
  }
  if (!made_.promise_kept)
    scene_.warn(accuracy_warning(scene_.options.accuracy, std::max(made_.judged_error, expected)) + name_);
}

void PlaneRun::make_terms(TaylorStage& taylor) {
  taylor_ = &taylor;
  scene_.progress.begin("Taylor terms" + name_);
  taylor.make_images(source_, made_, scene_.context());
  scene_.progress.end();
}

void PlaneRun::predict_noise() {
  const imager::WeightSums sums = weights_ ? source_.weight_sums() : imager::WeightSums::of_natural(report_.sums.weight);
  const std::string& taper = scene_.options.uvtaper;
  if (weights_ && !taper.empty() && !sums.outweigh_least(report_.sums.used))
    throw std::runtime_error("--uvtaper " + taper +
                             ": no sample keeps a weight that counts; expected a taper of larger radius in the "
                             "uv plane, or a smaller angle");
  report_.predicted_noise_jy = sums.noise_jy();
  if (weights_) report_.decisions.push_back(weights_decision(*weights_, sums));
  weights_.reset();
}

void PlaneRun::verify() {
  const imager::StageTimer timer(scene_.times, "verify");
  scene_.progress.begin("verify" + name_);
  const imager::MeasuredError measured = imager::measure_error(source_, made_.transform->images(), scene_.geometry,
                                                               made_.images, scene_.options.verify, scene_.context());
  scene_.progress.end();
  for (std::size_t s = 0; s < scene_.stokes.size(); ++s) report_.stokes[s].measured = measured.image[s];
  report_.measured_predict_rms = measured.predict_rms;
}

void PlaneRun::choose_beams() {
  const imager::StageTimer timer(scene_.times, "fit beam");
  const ImageOptions& o = scene_.options;
  report_.beams = choose_beam(made_.images.psf, scene_.geometry.cell_rad, restoring_beam(o), o.niter > 0 && !o.cube.is_cube());
  const std::string plane = name_.empty() ? "" : name_.substr(std::string(" of ").size()) + ": ";
  for (const std::string& warning : report_.beams->warnings) scene_.warn(plane + warning);
}

void PlaneRun::clean(CleanStage& stage, const nlohmann::json& option_values,
                     const std::function<void(std::size_t stokes, const imager::CleanState&)>& cycle) {
  for (std::size_t s = 0; s < scene_.stokes.size(); ++s) {
    const std::string of = scene_.stokes.size() > 1 ? " of " + stokes_name(scene_.stokes[s]) + name_ : name_;
    scene_.progress.begin("CLEAN" + of, true);
    cleaned_.push_back(clean(stage, s, option_values, [&](const imager::CleanState& state) { cycle(s, state); }));
    scene_.progress.end();
    const imager::CleanReport& report = cleaned_.back().report;
    report_.stokes[s].clean = report;
    if (report.stop == imager::CleanStop::diverging || report.stop == imager::CleanStop::diverging_from_best)
      scene_.warn(divergence_warning(report) + of);
  }
}

void PlaneRun::follow_clean() {
  scene_.progress.begin("CLEAN" + name_, true);  // rank 0 decides when it stops
  const imager::TaylorExpansion expansion = taylor_ == nullptr ? imager::TaylorExpansion{} : taylor_->expansion();
  for (std::size_t s = 0; s < scene_.stokes.size(); ++s)
    imager::follow_clean({source_, s}, *made_.transform, expansion, scene_.context());
}

imager::CleanResult PlaneRun::clean(CleanStage& stage, std::size_t stokes, const nlohmann::json& option_values,
                                    const imager::CycleProgress& cycle) {
  CleanScene clean{.samples = {source_, stokes},
                   .transform = *made_.transform,
                   .expansion = {},
                   .dirty = {&made_.images.dirty[stokes]},
                   .psf = {&made_.images.psf},
                   .main_lobe = *report_.beams->main_lobe,
                   .expected_error = report_.stokes[stokes].theory->expected_rms};
  if (taylor_ != nullptr) {
    clean.expansion = taylor_->expansion();
    for (const imager::Image& dirty : taylor_->images().dirty) clean.dirty.push_back(&dirty);
    clean.psf = taylor_->psf();
  }
  imager::CleanResult result = stage.run(clean, option_values, cycle, scene_.context());
  made_.images.dirty[stokes] = {};
  if (const imager::Image* const mask = stage.mask(stokes); mask != nullptr) result.mask = *mask;
  return result;
}

}  // namespace misfit::tools
