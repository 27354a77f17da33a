#include "tools/run/channel_run.h"

#include <algorithm>
#include <utility>

#include "imager/clean/shared_model.h"
#include "imager/direct/verify.h"
#include "imager/numerics/page_pool.h"
#include "tools/base/interrupt.h"
#include "tools/run/beam_choice.h"
#include "tools/run/clean_doubts.h"
#include "tools/run/image_files.h"
#include "tools/run/run_messages.h"
#include "tools/run/start_model.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {

bool MadeChannel::stopped() const {
  return std::any_of(report.stokes.begin(), report.stokes.end(),
                     [](const StokesReport& stokes) { return stokes.clean && stokes.clean->stop == imager::CleanStop::user; });
}

namespace {

/// True if dirty images are used only to begin CLEAN. With several Stokes parameters or channels some may have nothing to
/// clean.
bool images_begin_clean(const ChannelScene& scene) {
  const TypedClean& o = scene.options.clean;
  return o.niter > 0 && o.startmodel.empty() && scene.header.stokes.size() == 1 && !scene.options.cube.is_cube();
}

}  // namespace

ChannelRun::ChannelRun(const ChannelScene& scene, int channel, std::unique_ptr<ChannelSamples> samples)
    : scene_(scene),
      samples_(std::move(samples)),
      name_(scene.told != nullptr ? "" : " of plane " + std::to_string(channel)),
      silent_(true) {
  report().channel = channel;
  report().frequency_hz = scene.header.spectral.frequency_hz(channel);
  report().stokes.clear();
  for (const imager::Stokes stokes : scene.header.stokes) report().stokes.push_back({.stokes = stokes});
}

imager::Context ChannelRun::context() {
  const auto update = [this](std::uint64_t done, std::uint64_t total) {
    if (scene_.given_up) throw Interrupted();
    progress().update(done, total);
  };
  return {scene_.threads, &times(), update};
}

imager::StageTimes& ChannelRun::times() {
  return scene_.told != nullptr ? scene_.told->times : made_.times;
}

ProgressLine& ChannelRun::progress() {
  return scene_.told != nullptr ? scene_.told->progress : silent_;
}

void ChannelRun::warn(const std::string& sentence) {
  if (scene_.told != nullptr)
    scene_.told->warn(sentence);
  else
    made_.warnings.push_back(sentence);
}

void ChannelRun::weigh() {
  const imager::WeightingOptions options =
      weighting_options(scene_.options.weighting, scene_.header.spectral, scene_.pointings);
  if (options.none()) return;
  progress().begin("weights" + name_);
  weigh(imager::make_imaging_weights(samples(), options, scene_.header.geometry, context()));
  progress().end();
}

void ChannelRun::weigh(std::shared_ptr<const imager::ImagingWeights> weights) {
  const imager::StageTimer timer(times(), imager::stage::weights);
  weights_ = std::move(weights);
  samples().apply(weights_, scene_.threads);
}

void ChannelRun::make_dirty(imager::GriddingPlan plan, std::shared_ptr<const imager::PlannedTransform> transform) {
  progress().begin("dirty image and PSF" + name_);
  naming_taken([&] {
    images_ = imager::make_accurate_images(samples(), std::move(plan), context(), std::move(transform), taken(),
                                           images_begin_clean(scene_));
  });
  if (scene_.taken != nullptr && scene_.images_here) scene_.taken->require_weights(report().channel, images_.images.sums);
  progress().end();
  report().sums = images_.images.sums.front();
  made_.outside_grid = report().sums.outside_grid;
  report().made_twice = images_.plan.request.accuracy != scene_.options.gridding.accuracy;  // a second pass asks for more
  predict_noise();
  const imager::StageTimer timer(times(), imager::stage::statistics);
  const imager::NeglectedPhase phase = imager::neglected_w_phase(scene_.reach, samples().w_spread(), scene_.header.geometry);
  double expected = 0;
  for (std::size_t s = 0; s < scene_.header.stokes.size(); ++s) {
    const double rms = images_.images.dirty_statistics[s].root_mean_square();
    if (!scene_.options.taken.calcres) continue;  // its errors are not of this run's making
    report().stokes[s].theory =
        imager::theoretical_error(images_.plan, images_.images.sums[s], rms, phase, &images_.images.normalisation);
    expected = std::max(expected, report().stokes[s].theory->expected_rms);
  }
  if (!images_.promise_kept)
    warn(accuracy_warning(scene_.options.gridding.accuracy, std::max(images_.judged_error, expected)) + name_);
}

imager::TakenImages ChannelRun::taken() {
  const ImageOptions& o = scene_.options;
  const auto read = [this] {
    former_ = scene_.taken->read(report().channel);
    imager::FormerImages first;
    if (!former_.psf.empty()) first.psf = std::move(former_.psf.front());
    if (!former_.residual.empty()) first.dirty = std::move(former_.residual.front());
    return first;
  };
  return {!o.taken.calcres, !o.taken.calcpsf, !o.clean.startmodel.empty(), read};
}

/// The images of terms after the first, which make_dirty() read with those of the first.
TakenTerms ChannelRun::taken_terms() {
  TakenTerms terms{taken(), {}};
  for (std::size_t k = 1; k < former_.psf.size(); ++k) terms.images.psf.push_back(std::move(former_.psf[k]));
  for (std::size_t t = 1; t < former_.residual.size(); ++t)
    terms.images.dirty.push_back(std::move(former_.residual[t].front()));
  return terms;
}

void ChannelRun::predict_noise() {
  const imager::WeightSums sums = weights_ ? samples().weight_sums() : imager::WeightSums::of_natural(report().sums.weight);
  if (weights_) require_weight(scene_.options.weighting, sums, report().sums.used, name_);
  report().predicted_noise_jy = sums.noise_jy() * images_.images.normalisation.noise_factor(report().sums.weight);
  if (weights_) report().decisions.push_back(weights_decision(*weights_, sums));
  weights_.reset();
}

void ChannelRun::make_terms() {
  if (scene_.options.taylor.nterms == 1) return;
  taylor_.emplace(taylor_expansion(scene_.options.taylor, scene_.header.observation), scene_.threads);
  progress().begin("Taylor terms" + name_);
  const imager::Transform& transform = images_.dirty_accuracy != 0 ? images_.transform->psf() : images_.transform->images();
  const imager::ImagedData imaged{{samples(), 0}, transform, images_.images.normalisation};
  naming_taken([&] { taylor_->make_images(imaged, images_, taken_terms(), context()); });
  progress().end();
}

/// Every rank reads the start model, since all ranks predict it.
void ChannelRun::check_start() {
  const ImageOptions& o = scene_.options;
  if (o.taken.calcres || o.clean.startmodel.empty()) return;
  std::optional<StartModel> start;
  const auto locked = [](const auto& act) {  // files are opened and closed in it, too
    const std::lock_guard lock(image_files_mutex());
    act();
  };
  locked([&] { start.emplace(o, scene_.header).read(report().channel); });
  const imager::ComparedPixels pixels(images_.plan, images_.transform->images());
  const imager::TaylorExpansion expansion = taylor_ ? taylor_->expansion() : imager::TaylorExpansion{};
  const auto terms = static_cast<std::size_t>(expansion.terms);
  progress().begin("check of the residual" + name_);
  for (std::size_t s = 0; s < scene_.header.stokes.size(); ++s) {
    std::vector<imager::Image> model;
    for (const imager::Image* term : start->images(s)) model.push_back(*term);
    model.resize(terms, imager::Image(model.front().width, model.front().height));
    const std::vector<imager::Image> values = imager::make_taylor_residuals(
        {{samples(), s}, pixels.transform(), images_.images.normalisation}, std::move(model), expansion, context());
    if (samples().ranks().first()) naming_taken([&] { compare_residuals(s, pixels, values); });
  }
  locked([&] { start.reset(); });
  progress().end();
}

/// Compares residuals that were taken with `values` [term], the residuals of the start model in some pixels.
void ChannelRun::compare_residuals(std::size_t stokes, const imager::ComparedPixels& pixels,
                                   const std::vector<imager::Image>& values) {
  const imager::Image& first = images_.images.dirty[stokes];
  const imager::SampleSums& sums = images_.images.sums[stokes];
  // The subtracted model is as exact as images of the data, which are about this bright.
  const double data_rms = images_.images.psf_statistics.root_mean_square() * std::sqrt(sums.weight_square / sums.weight);
  for (std::size_t t = 0; t < values.size(); ++t) {
    const imager::Image& residual = t == 0 ? first : taylor_->images().dirty[t - 1];
    const double rms = std::max(root_mean_square(residual), t == 0 ? 0 : taylor_->distance_rms(t) * root_mean_square(first));
    const double accuracy = images_.plan.request.accuracy * std::max(1.0, data_rms / rms);
    pixels.require(residual, values[t], rms, accuracy, {false, stokes, static_cast<int>(t)});
  }
}

void ChannelRun::verify() {
  if (scene_.options.verify == 0) return;
  const imager::StageTimer timer(times(), imager::stage::verify);
  progress().begin("verify" + name_);
  // CLEAN may begin with a less exact image, whether or not the run verifies.
  std::optional<imager::DirtyImages> exact;
  imager::StageTimes within;  // they are this stage's
  if (images_.dirty_accuracy != 0)
    exact = imager::make_dirty_images(samples(), images_.transform->images(), imager::AdjointOptions{},
                                      {.threads = scene_.threads, .times = &within});
  const imager::MeasuredError measured =
      imager::measure_error(samples(), images_.transform->images(), scene_.header.geometry, exact ? *exact : images_.images,
                            scene_.options.verify, context(), imager::response_of(images_.plan));
  progress().end();
  for (std::size_t s = 0; s < scene_.header.stokes.size(); ++s) report().stokes[s].measured = measured.image[s];
  report().measured_predict_rms = measured.predict_rms;
}

void ChannelRun::choose_beams() {
  const imager::StageTimer timer(times(), imager::stage::fit_beam);
  const ImageOptions& o = scene_.options;
  report().beams = choose_beam(images_.images.psf, scene_.header.geometry.cell_rad, restoring_beam(o.clean.restoringbeam),
                               o.clean.runs() && !o.cube.is_cube());
  const std::string plane = name_.empty() ? "" : name_.substr(std::string(" of ").size()) + ": ";
  for (const std::string& warning : report().beams->warnings) warn(plane + warning);
}

void ChannelRun::begin_clean(std::unique_ptr<CleanStage> stage, const imager::Image* primary_beam) {
  stage_ = std::move(stage);
  {
    const std::lock_guard lock(image_files_mutex());
    stage_->begin_channel(report().channel);
  }
  if (primary_beam != nullptr) stage_->keep_within(*primary_beam);
  if (scene_.told == nullptr)
    made_.doubts = stage_->warnings();  // else they were told before, but for that of the limit
  else if (const std::string closed = stage_->closed_mask_warning(); options().primary_beam.pbmask > 0 && !closed.empty())
    warn(closed);
}

std::unique_ptr<CleanStage> ChannelRun::clean() {
  const std::vector<imager::Stokes>& stokes = scene_.header.stokes;
  for (std::size_t s = 0; s < stokes.size(); ++s) {
    const std::string of = stokes.size() > 1 ? " of " + stokes_name(stokes[s]) + name_ : name_;
    progress().begin("CLEAN" + of, true);
    iterations_.reset();
    cleaned().push_back(clean(s));
    progress().end();
    report().stokes[s].clean = cleaned().back().report;
    doubt_clean(s);
  }
  return std::move(stage_);
}

void ChannelRun::doubt_clean(std::size_t stokes) {
  const CleanedImage image{.components = cleaned().back().components.components().size(),
                           .visibilities = images_.images.sums[stokes].used,
                           .limited = stage_->mask(stokes) != nullptr,
                           .one_of_many = scene_.told == nullptr};
  const bool several = scene_.header.stokes.size() > 1;
  for (const std::string& sentence : clean_doubts(cleaned().back().report, options().clean, image)) {
    const std::string doubt = (several ? stokes_name(scene_.header.stokes[stokes]) + ": " : "") + sentence;
    if (scene_.told != nullptr)
      scene_.told->warn(doubt);
    else
      made_.doubts.push_back(doubt);
  }
}

void ChannelRun::follow_clean() {
  progress().begin("CLEAN" + name_, true);  // rank 0 decides when it stops
  const imager::TaylorExpansion expansion = taylor_ ? taylor_->expansion() : imager::TaylorExpansion{};
  for (std::size_t s = 0; s < scene_.header.stokes.size(); ++s)
    imager::follow_clean(imaged(s), images_.transform->coarser(), expansion, context());
}

/// Called with the state that CLEAN begins with, which may be from a run before, and after every major cycle.
void ChannelRun::count_cycle(const imager::CleanState& state) {
  const int iterations = state.cycles.back().iterations;
  if (iterations_) {
    ++made_.major_cycles;
    made_.components += iterations - *iterations_;
  }
  iterations_ = iterations;
  if (scene_.told != nullptr && state.cycles.size() > 1) progress().say("  " + cycle_message(state));
}

imager::ImagedData ChannelRun::imaged(std::size_t stokes) {
  return {{samples(), stokes}, *images_.transform, images_.images.normalisation};
}

imager::CleanResult ChannelRun::clean(std::size_t stokes) {
  const auto& theory = report().stokes[stokes].theory;
  CleanScene clean{.imaged = imaged(stokes),
                   .expansion = {},
                   .dirty = {},
                   .dirty_accuracy = images_.dirty_accuracy,
                   .of_start = !scene_.options.taken.calcres && !scene_.options.clean.startmodel.empty(),
                   .psf = {&images_.images.psf},
                   .same_sidelobes = images_.plan.leaves_w_out(),
                   .main_lobe = *report().beams->main_lobe,
                   .coarser = images_.transform->coarser(),
                   .data_jy = images_.images.sums[stokes].data_jy(),
                   .expected_error = theory ? theory->expected_rms : images_.plan.expected_error};
  clean.dirty.push_back(std::move(images_.images.dirty[stokes]));
  if (taylor_) {
    clean.expansion = taylor_->expansion();
    for (imager::Image& dirty : taylor_->images().dirty) clean.dirty.push_back(std::move(dirty));
    clean.psf = taylor_->psf();
  }
  const auto cycle = [this](const imager::CleanState& state) { count_cycle(state); };
  imager::CleanResult result = stage_->run(std::move(clean), scene_.option_values, cycle, context());
  if (!stage_->words_on_state().empty()) made_.doubts.push_back(stage_->words_on_state());
  const imager::Image* const mask = stage_->mask(stokes);
  if (result.mask.pixel.empty() && mask != nullptr) result.mask = *mask;  // else it made one within that
  return result;
}

void ChannelRun::release_samples() {
  samples_.reset();
  images_.transform.reset();
  if (scene_.told != nullptr) imager::PagePool::release();  // nothing as large follows
}

}  // namespace misfit::tools
