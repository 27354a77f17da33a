#include "tools/scene/measure.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/stage_times.h"
#include "ms_io/measurement_set.h"
#include "tools/run/gridding_options.h"
#include "tools/run/set_notes.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {
namespace {

std::string work_of(const imager::GriddingPlan& plan) {
  if (plan.direct) return "direct sums";
  const imager::WideTransformOptions& o = plan.options;
  std::string work = std::to_string(o.nu) + " x " + std::to_string(o.nv);
  for (const kernels::Kernel* kernel : {&o.kernel_u, &o.kernel_v, &o.kernel_w})
    if (kernel->width() > 0)
      work += ", W " + std::to_string(kernel->width()) + " degree " + std::to_string(kernel->polynomial.degree());
  if (o.has_w_axis())
    work += ", " + std::to_string(plan.choice.best.work.planes) + " planes in " + std::to_string(o.facets_l) + " x " +
            std::to_string(o.facets_m) + " facets";
  if (o.lookup) work += ", " + imager::evaluation_of(o);
  return work + (o.precision == imager::Precision::single_precision ? ", single" : ", double");
}

constexpr std::size_t total_weight = 0, weighted_magnitude = 1;  ///< of a Fingerprint, Σ w and Σ w|V|

void add_to(Fingerprint& print, const imager::VisibilityBlock& block) {
  for (std::size_t i = 0; i < block.samples(); ++i) {
    if (block.weight[i] == 0) continue;
    const double weight{block.weight[i]};
    const std::complex<double> visibility(block.visibility[i]);
    print[total_weight] += weight;
    print[weighted_magnitude] += weight * std::abs(visibility);
    print[2] += weight * visibility.real();
    print[3] += weight * visibility.imag();
  }
  constexpr double apart[3]{1, 1.7, 2.9};  // so that exchanged coordinates differ
  for (std::size_t k = 0; k < block.uvw_m.size(); ++k) print[4] += apart[k % 3] * block.uvw_m[k];
}

/// The pixels of each place: as many as some seconds of direct sums allow, or a minute. Equal scenes have equal numbers of
/// pixels.
int pixels_for(std::uint64_t samples, bool quick) {
  const double terms = quick ? 1e9 : 4e9, least = quick ? 128 : 512;
  return static_cast<int>(std::clamp(terms / std::max(1.0, static_cast<double>(samples)), least, 8 * least));
}

}  // namespace

Scene::Scene(const ImageOptions& options, bool quick, const imager::Progress& progress)
    : options_(options), threads_(options.threads == 0 ? imager::available_threads() : options.threads) {
  const ms_io::MeasurementSet set(options.vis, selection_of(options), options.datacolumn);
  geometry_ = geometry_of(options, set.observation().phase_centre);
  warnings_ = notes_on_sets(options, set, geometry_).warnings;
  reach_ = set.reach();
  const imager::Stopwatch watch;
  const auto stream = set.open();
  while (auto block = stream->next()) visibilities_.append(std::move(block));
  read_s_ = watch.seconds();
  for (std::string& warning : notes_on_data(set, imager::alone())) warnings_.push_back(std::move(warning));
  weigh();
  if (fingerprint_[total_weight] > 0 && fingerprint_[weighted_magnitude] == 0)
    throw std::runtime_error(names_of(options.vis) + ": all visibilities of " + options.datacolumn +
                             " that can be used are 0, and so are images of them: there is no error to measure; expected a "
                             "column that was filled");
  truth_ =
      std::make_unique<SceneTruth>(visibilities_, geometry_, pixels_for(visibilities_.samples(), quick), threads_, progress);
}

void Scene::weigh() {
  const auto weights =
      imager::make_imaging_weights(visibilities_, weighting_options(options_.weighting), geometry_, {threads_});
  if (weights) require_weight(options_.weighting, weights->put_on(visibilities_, threads_).sums, visibilities_.samples());
  const auto stream = visibilities_.open();
  while (const auto block = stream->next()) {
    w_spread_.add(*block);
    add_to(fingerprint_, *block);
  }
}

Scene::Plans Scene::plans_of(const ScenePoint& point) const {
  imager::GriddingRequest request = gridding_request(options_of(options_, point).gridding, threads_);
  request.geometry = geometry_;
  request.samples = visibilities_.samples();
  request.max_abs_w = reach_.max_abs_w;
  Plans plans{imager::plan_gridding(request)};
  if (point.accuracy == 0) return plans;
  imager::AccurateImages made = imager::make_accurate_images(visibilities_, plans.front(), {});
  if (made.plan.request.accuracy != request.accuracy) plans.push_back(std::move(made.plan));
  return plans;
}

imager::DirtyImages Scene::image(const imager::Transform& transform, SceneSeconds& seconds) const {
  imager::StageTimes times;
  imager::DirtyImages made = imager::make_dirty_images(visibilities_, transform, imager::AdjointOptions{}, {.times = &times});
  for (const auto& [stage, spent] : times.stages()) (stage == "fft" ? seconds.fft : seconds.grid) += spent;
  return made;
}

void Scene::predict(const imager::Transform& transform, SceneSeconds& seconds, SceneErrors* errors) const {
  const imager::Stopwatch watch;
  const auto prediction = transform.predict(truth_->model());
  std::vector<std::shared_ptr<const imager::VisibilityBlock>> blocks;
  const auto stream = visibilities_.open();
  while (auto block = stream->next()) blocks.push_back(std::move(block));
  std::vector<const imager::VisibilityBlock*> plain;
  for (const auto& block : blocks) plain.push_back(block.get());
  const auto predicted = prediction->at_usable_of(plain);
  seconds.predict_fft = prediction->fft_s();
  seconds.degrid = watch.seconds() - seconds.predict_fft;
  if (errors == nullptr) return;
  for (std::size_t b = 0; b < predicted.size(); ++b) truth_->compare(b, predicted[b], *errors);
  truth_->finish(*errors);
}

void Scene::describe(const Plans& plans, const imager::DirtyImages& made, PointResult& result) const {
  const imager::GriddingPlan& plan = plans.back();
  const imager::WideTransformOptions& o = plan.options;
  const imager::NeglectedPhase phase = imager::neglected_w_phase(reach_, w_spread_, geometry_);
  const imager::TheoreticalError theory =
      imager::theoretical_error(plan, made.sums.front(), imager::root_mean_square(made.dirty.front()), phase);
  const imager::TransformMemory memory = imager::memory_of(plan);
  result.passes = static_cast<int>(plans.size());
  result.width = o.kernel_u.width();
  result.width_w = o.has_w_axis() ? o.kernel_w.width() : 0;
  result.x0 = o.kernel_u.x0;
  result.padding = o.nu / std::ceil(1.0 * o.geometry.width / o.facets_l);
  result.evaluation = plan.direct ? "direct sums" : imager::evaluation_of(o);
  result.precision = o.precision == imager::Precision::single_precision && !plan.direct ? "single" : "double";
  result.work.clear();
  for (const imager::GriddingPlan& pass : plans) result.work += (result.work.empty() ? "" : " and ") + work_of(pass);
  result.memory_bytes = memory.visibilities + memory.fft;
  result.expected_rms = theory.expected_rms;
  result.bound_rms = theory.bound_rms;
  result.bound_max = theory.bound_max;
}

void Scene::run(PointResult& result, int stretch) {
  const std::string name = options_text(result.point);
  auto plans = plans_.find(name);
  if (plans == plans_.end()) {
    try {
      plans = plans_.emplace(name, plans_of(result.point)).first;
    } catch (const std::invalid_argument& error) {
      result.refused = error.what();
      return;
    }
  }
  SceneSeconds seconds{.stretch = stretch};
  std::unique_ptr<imager::PlannedTransform> transform;
  imager::DirtyImages made;
  for (const imager::GriddingPlan& pass : plans->second) {
    transform.reset();  // there may be no room for both
    transform = std::make_unique<imager::PlannedTransform>(pass);
    made = image(transform->images(), seconds);
  }
  const bool first = result.runs.empty();
  if (first) {
    describe(plans->second, made, result);
    result.errors = truth_->errors_of(made.dirty.front());
  }
  predict(transform->images(), seconds, first ? &result.errors : nullptr);
  result.runs.push_back(seconds);
}

}  // namespace misfit::tools
