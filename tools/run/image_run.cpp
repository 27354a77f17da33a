#include "tools/run/image_run.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "imager/data/noise.h"
#include "imager/data/stokes.h"
#include "imager/numerics/parallel.h"
#include "ms_io/model_writer.h"
#include "tools/base/files.h"
#include "tools/base/json_text.h"
#include "tools/base/progress.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/run/changed_files.h"
#include "tools/run/clean_stage.h"
#include "tools/run/data_columns.h"
#include "tools/run/model_stage.h"
#include "tools/run/outside_stage.h"
#include "tools/run/plane_run.h"
#include "tools/run/primary_beam_stage.h"
#include "tools/run/product_stage.h"
#include "tools/run/run_messages.h"
#include "tools/run/run_plan.h"
#include "tools/run/run_report.h"
#include "tools/run/set_notes.h"
#include "tools/run/sharing.h"
#include "tools/run/taylor_options.h"
#include "tools/run/taylor_stage.h"
#include "tools/run/weighting_options.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {
namespace {

/// One run of `misfit image`, from options to files. The steps are called in the order in which they stand here. Ranks take
/// them together; what needs images, or writes, the first takes alone.
class ImageRun {
 public:
  ImageRun(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks)
      : o_(options),
        ranks_(ranks),
        stokes_(imager::parse_stokes(options.stokes)),
        threads_(options.threads == 0 ? imager::available_threads(ranks.on_these_cores()) : options.threads),
        progress_(options.quiet || !ranks.first()) {
    report_.command_line = call.command_line;
    report_.options = call.option_values;
    report_.times = &times_;
  }

  /// Whether all was done, and the user did not stop it.
  bool run() {
    try {
      return take_steps();
    } catch (const std::runtime_error&) {
      rethrow_with_changed_files(ranks_.first() ? set_.get() : nullptr);
    }
  }

 private:
  bool take_steps() {
    open();
    plan();
    if (o_.dry_run) {
      if (!o_.quiet && ranks_.first()) print_plan(plan_, expected());
      return true;
    }
    plane_->weigh();
    make_dirty();
    if (taylor_) plane_->make_terms(*taylor_);
    if (o_.verify > 0) plane_->verify();
    weigh_primary_beam();
    if (ranks_.first()) begin_products();
    if (o_.niter > 0) clean();
    if (o_.check_outside) look_outside();
    release_visibilities();
    if (ranks_.first()) {
      write_images();
      write_report();
    }
    if (o_.savemodel == "modelcolumn") save_model();
    if (ranks_.first()) summarise();
    bool done = !stopped();
    imager::share_values(ranks_, done);
    return done;
  }

  void warn(const std::string& sentence) {
    report_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }

  void open() {
    const imager::StageTimer timer(times_, "open");
    if (!o_.dry_run && ranks_.first()) name_ = claim_product_paths(o_);
    if (o_.savemodel == "modelcolumn" && ranks_.first())
      for (const std::string& set : o_.vis) ms_io::require_writable(set);
    set_ = std::make_unique<ms_io::MeasurementSet>(o_.vis, selection_of(o_), o_.datacolumn, stokes_);
    if (!ranks_.alone()) set_ = set_->share(ranks_);
    if (o_.savemodel != "none")
      if (const std::string words = left_out_of_model_warning(stokes_, *set_); !words.empty()) warn(words);
    check_taylor_band(o_, set_->spectral_windows());
    geometry_ = geometry_of(o_, set_->observation().phase_centre);
    notes_ = notes_on_sets(o_, *set_, geometry_);
    for (const std::string& warning : notes_.warnings) warn(warning);
    reach_ = set_->reach();
    if (wants_primary_beam(o_))
      primary_beam_ = std::make_unique<PrimaryBeamStage>(
          o_, BeamScene{set_->beam_rows(), geometry_, set_->observation().frequency_hz}, threads_);
    if (o_.nterms > 1) taylor_ = std::make_unique<TaylorStage>(taylor_expansion(o_, set_->observation()), threads_);
    if (o_.niter == 0 || !ranks_.first()) return;
    const imager::Observation& observation = set_->observation();
    clean_ = std::make_unique<CleanStage>(o_,
                                          imager::ImageHeader{.geometry = geometry_,
                                                              .observation = observation,
                                                              .spectral = whole_band(observation),
                                                              .stokes = stokes_,
                                                              .cards = {},
                                                              .history = {}},
                                          threads_);
    clean_->begin_channel(0);
    for (const std::string& words : clean_->words_on_files()) warn(words);
    for (const std::string& words : clean_->warnings()) warn(words);
  }

  void plan() {
    const bool mask = clean_ && (clean_->mask(0) != nullptr || o_.usemask == "auto");
    const auto own = static_cast<double>(set_->samples());
    double all = own;
    imager::sum_over(ranks_, all);
    const double enlarged = o_.scale.enlarged(all);
    const RunScene scene{.options = o_,
                         .set = *set_,
                         .ranks = ranks_,
                         .geometry = geometry_,
                         .reach = reach_,
                         .threads = threads_,
                         .mask = mask,
                         .samples = all * enlarged,
                         .share = own / all,
                         .enlarged = enlarged};
    plan_ = plan_run(scene, times_, progress_);
    plan_.decisions.insert(plan_.decisions.end(), notes_.decisions.begin(), notes_.decisions.end());
    if (primary_beam_) plan_.decisions.push_back(primary_beam_->decision());
    for (const std::string& warning : plan_.warnings) warn(warning);
    if (primary_beam_)
      for (const std::string& doubt : primary_beam_->doubts()) warn(doubt);
    work_ = work_of(scene, plan_);
    foretell(scene, forecast_, work_, times_, plan_);
    report_.plan = plan_.decisions;
    report_.estimated_memory_bytes = plan_.memory.total();
    // Ranks exchange the same in every pass, so that all keep visibilities or none does.
    plan_.streaming.keep = !imager::any_of(ranks_, !plan_.streaming.keep);
    source_ = std::make_unique<imager::StreamedVisibilities>(*set_, plan_.streaming);
    scene_ = std::make_unique<PlaneScene>(PlaneScene{o_, geometry_, stokes_, reach_, threads_, progress_, times_,
                                                     [this](const std::string& sentence) { warn(sentence); }});
    plane_ = std::make_unique<PlaneRun>(*scene_, *source_, "");
  }

  std::vector<StageSeconds> expected() const { return expected_seconds(plan_, forecast_, work_); }

  void make_dirty() {
    plane_->make_dirty(plan_.gridding);
    const imager::AccurateImages& made = plane_->made();
    work_.plan = &made.plan;
    report_.plan.insert(report_.plan.end(), made.plan.decisions.begin(), made.plan.decisions.end());
    report_.accuracy = o_.accuracy;
    report_.gridding = &made.plan;
    count_samples();
    for (const imager::Decision& decision : plane_->report().decisions) report_.plan.push_back(decision);
  }

  /// What was read; samples that the pixel size cannot represent, and the pixel size that could.
  void count_samples() {
    const imager::SampleSums& sums = plane_->report().sums;
    report_.counts = source_->counts();
    report_.counts.outside_grid = sums.outside_grid;
    report_.counts.used = sums.used;
    report_.plan.push_back(left_out_decision(report_.counts));
    if (sums.outside_grid > 0) warn(outside_grid_warning(sums.outside_grid, reach_));
    for (const std::string& warning : notes_on_data(*set_, ranks_)) warn(warning);
  }

  void weigh_primary_beam() {
    if (!primary_beam_) return;
    const imager::StageTimer timer(times_, "primary beam");
    primary_beam_->weigh(*source_);
  }

  void begin_products() {
    plane_->choose_beams();
    report_.planes = {plane_->report()};
    imager::Observation observation = set_->observation();
    if (taylor_) observation.frequency_hz = taylor_->expansion().reference_hz;
    products_ = std::make_unique<ProductStage>(
        o_,
        ProductScene{geometry_, stokes_, observation, history_of(report_.command_line, set_->data_columns()),
                     error_cards(report_), plane_->report().beams->restoring, threads_},
        times_);
    if (taylor_) products_->set_taylor(*taylor_);
    products_->draw_dirty(source_->uv_coverage(), plane_->made().images,
                          [this](std::size_t s) { return clean_ ? clean_->mask(s) : nullptr; });
  }

  void clean() {
    if (!ranks_.first()) return plane_->follow_clean();
    std::size_t now = stokes_.size();  // none
    plane_->clean(*clean_, report_.options, [&](std::size_t stokes, const imager::CleanState& state) {
      if (stokes != std::exchange(now, stokes)) iterations_before_.reset();
      count_cycle(state.cycles.back());
      if (state.cycles.size() > 1) progress_.say("  " + cycle_message(state));
    });
    clean_.reset();
  }

  /// Told of the state with which CLEAN begins, which may be that of a run before, and after every major cycle.
  void count_cycle(const imager::MajorCycle& cycle) {
    if (!iterations_before_) {
      iterations_before_ = cycle.iterations;
      return;
    }
    ++work_.major_cycles;
    work_.components += cycle.iterations - *iterations_before_;
    iterations_before_ = cycle.iterations;
  }

  void look_outside() {
    const imager::StageTimer timer(times_, "sources outside");
    imager::StageTimes own;  // its gridding is not this image's
    progress_.begin("sources outside", true);
    const imager::AccurateImages& made = plane_->made();
    const auto& cleaned = plane_->cleaned();
    const double noise_jy = !ranks_.first()   ? 0
                            : cleaned.empty() ? imager::robust_noise(made.images.dirty.front(), threads_)
                                              : cleaned.front().report.final_state().rms_jy;
    outside_ = check_outside(*source_, made.plan, *plan_.wider, made.images, {noise_jy, !weighting_options(o_).none()},
                             {threads_, &own, scene_->context().progress});
    progress_.end();
    if (!ranks_.first()) return;
    report_.outside = &outside_;
    imager::Decision told = outside_decision(outside_);
    if (stokes_.size() > 1) told.item += " in " + stokes_name(stokes_.front()) + " alone";
    report_.plan.push_back(told);
    progress_.say(told.item + ": " + told.decision + "; " + told.because);
    for (const std::string& line : outside_places(outside_)) progress_.say(line);
    for (const std::string& warning : outside_warnings(outside_)) warn(warning);
  }

  /// They make room for the pictures, and are closed before a column is written.
  void release_visibilities() {
    if (ranks_.first())
      if (const std::string warning = changed_files_warning(*set_); !warning.empty()) warn(warning);
    source_.reset();
    set_.reset();
    plane_->made().transform.reset();
  }

  bool stopped() const {
    const auto& cleaned = plane_->cleaned();
    return std::any_of(cleaned.begin(), cleaned.end(),
                       [](const auto& result) { return result.report.stop == imager::CleanStop::user; });
  }

  /// Gives all ranks the models.
  void share_models() {
    plane_->cleaned().resize(stokes_.size());
    for (imager::CleanResult& result : plane_->cleaned()) {
      result.further_models.resize(static_cast<std::size_t>(o_.nterms - 1));
      share_image(result.model);
      for (imager::Image& further : result.further_models) share_image(further);
    }
  }

  void share_image(imager::Image& image) const {
    imager::share_values(ranks_, image.width, image.height);
    imager::share_list(ranks_, image.pixel);
  }

  void save_model() {
    progress_.begin("save model", true);  // a column half written helps no one
    if (!ranks_.alone()) share_models();
    const SavedModel model{geometry_,
                           threads_,
                           stokes_,
                           plane_->cleaned(),
                           json_text(report_.options),
                           [this](const std::string& sentence) { progress_.say(sentence); },
                           taylor_ ? taylor_->expansion() : imager::TaylorExpansion()};
    tools::save_model(o_, model, ranks_, scene_->context().progress);
    progress_.end();
  }

  void write_images() {
    count_pixels();
    report_.planes = {plane_->report()};
    imager::DirtyImages& images = plane_->made().images;
    auto& cleaned = plane_->cleaned();
    if (primary_beam_) set_primary_beam();
    std::string removed;
    for (const std::string& path :
         cleaned.empty() ? products_->write(std::move(images)) : products_->write(std::move(images.psf), cleaned))
      removed += (removed.empty() ? "" : ", ") + path;
    if (!removed.empty()) progress_.say("removed what an earlier run left: " + removed);
  }

  void set_primary_beam() {
    const imager::StageTimer timer(times_, "primary beam");
    std::vector<imager::Image> beam;  // [term]
    if (taylor_) {
      taylor_beam_ = primary_beam_->of_terms(taylor_->expansion());
      beam = taylor_beam_->terms();
    } else {
      beam.push_back(primary_beam_->whole_band());
    }
    if (const std::string warning = primary_beam_->warning_of(beam.front()); !warning.empty()) warn(warning);
    products_->set_primary_beam(std::move(beam), taylor_beam_ ? &*taylor_beam_ : nullptr);
  }

  void count_pixels() {
    const imager::StageTimer timer(times_, "statistics");
    const auto& cleaned = plane_->cleaned();
    for (std::size_t s = 0; s < stokes_.size(); ++s) {
      const imager::Image& image = cleaned.empty() ? plane_->made().images.dirty[s] : cleaned[s].residual;
      const double noise_jy = cleaned.empty() ? imager::sampled_noise(image) : cleaned[s].report.final_state().rms_jy;
      plane_->report().stokes[s].histogram = pixel_histogram(image, noise_jy, threads_);
    }
  }

  /// Nothing where gnuplot cannot draw it.
  std::string histogram_drawing() {
    const imager::StageTimer timer(times_, "draw pictures");
    try {
      const PixelHistogram& histogram = report_.planes.front().stokes.front().histogram;
      return histogram.pixels == 0 ? "" : draw_svg(histogram_figure(histogram));
    } catch (const std::runtime_error&) {  // the pictures say why
      return "";
    }
  }

  void write_report() {
    const std::string histogram = histogram_drawing();
    std::vector<PagePicture> pictures;
    if (const std::string failure = products_->finish_pictures(pictures); !failure.empty()) warn(failure);
    if (!ranks_.alone()) report_.plan.push_back(traffic_decision(ranks_.traffic(), times_.of("exchange")));
    report_.expected = expected();
    if (!plane_->report().made_twice) forecast_.learn(work_, times_);
    report_.wall_clock_s = watch_.seconds();
    const nlohmann::json json = report_json(report_);
    write_file(o_.imagename + ".report.json", json_text(json, 2) + "\n");
    write_file(o_.imagename + ".report.html", report_page(json, pictures, {histogram, ""}));
  }

  void summarise() const {
    if (!o_.quiet) std::printf("%s%s.report.html\n", summary(report_).c_str(), o_.imagename.c_str());
  }

  const ImageOptions& o_;
  const imager::Ranks& ranks_;
  std::unique_ptr<NameLock> name_;  ///< the first rank's
  std::vector<imager::Stokes> stokes_;
  int threads_;
  ProgressLine progress_;
  imager::Stopwatch watch_;
  imager::StageTimes times_;
  RunReport report_;
  TimeForecast forecast_{default_cache_folder()};
  RunWork work_;
  std::optional<int> iterations_before_;  ///< this run's CLEAN

  std::unique_ptr<ms_io::MeasurementSet> set_;
  imager::ImageGeometry geometry_;
  imager::UvwReach reach_;
  FieldNotes notes_;
  std::unique_ptr<PrimaryBeamStage> primary_beam_;  ///< null where none is wanted
  std::unique_ptr<CleanStage> clean_;               ///< null without CLEAN, and after it
  std::unique_ptr<TaylorStage> taylor_;             ///< null where there is one term
  std::optional<imager::TaylorBeam> taylor_beam_;   ///< of several, where a primary beam is wanted
  RunPlan plan_;
  std::unique_ptr<imager::StreamedVisibilities> source_;
  std::unique_ptr<PlaneScene> scene_;
  std::unique_ptr<PlaneRun> plane_;
  OutsideReport outside_;
  std::unique_ptr<ProductStage> products_;
};

}  // namespace

bool run_image(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks) {
  return ImageRun(options, call, ranks).run();
}

}  // namespace misfit::tools
