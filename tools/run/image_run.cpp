#include "tools/run/image_run.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "imager/noise.h"
#include "imager/parallel.h"
#include "imager/stokes.h"
#include "imager/stokes_view.h"
#include "ms_io/model_writer.h"
#include "tools/base/files.h"
#include "tools/base/progress.h"
#include "tools/run/beam_choice.h"
#include "tools/run/clean_stage.h"
#include "tools/run/model_stage.h"
#include "tools/run/outside_stage.h"
#include "tools/run/product_stage.h"
#include "tools/run/run_messages.h"
#include "tools/run/run_plan.h"
#include "tools/run/run_report.h"
#include "tools/run/weighting_options.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {
namespace {

/// One run of `misfit image`, from options to files. The steps are called in the order in which they stand here.
class ImageRun {
 public:
  ImageRun(const ImageOptions& options, std::string command_line, nlohmann::json option_values)
      : o_(options),
        stokes_(imager::parse_stokes(options.stokes)),
        threads_(options.threads == 0 ? imager::available_threads() : options.threads),
        progress_(options.quiet) {
    report_.command_line = std::move(command_line);
    report_.options = std::move(option_values);
    report_.times = &times_;
    report_.stokes.clear();
    for (const imager::Stokes stokes : stokes_) report_.stokes.push_back({.stokes = stokes});
  }

  /// Whether all was done, and the user did not stop it.
  bool run() {
    open();
    plan();
    if (o_.dry_run) {
      if (!o_.quiet) print_plan(plan_, expected());
      return true;
    }
    weigh();
    make_dirty();
    if (o_.verify > 0) verify();
    choose_beams();
    begin_products();
    if (o_.niter > 0) clean();
    if (o_.check_outside) look_outside();
    release_visibilities();
    write_images();
    write_report();
    if (o_.savemodel == "modelcolumn") save_model();
    summarise();
    return std::none_of(cleaned_.begin(), cleaned_.end(),
                        [](const auto& result) { return result.report.stop == imager::CleanStop::user; });
  }

 private:
  imager::Progress progress() {
    return [this](std::uint64_t done, std::uint64_t total) { progress_.update(done, total); };
  }
  void warn(const std::string& sentence) {
    report_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }

  void open() {
    const imager::StageTimer timer(times_, "open");
    if (!o_.dry_run) check_writable_folder(o_.imagename);
    if (o_.savemodel == "modelcolumn")
      for (const std::string& set : o_.vis) ms_io::require_writable(set);
    set_ = std::make_unique<ms_io::MeasurementSet>(o_.vis, selection_of(o_), o_.datacolumn, stokes_);
    for (const std::string& sentence : set_->incomplete_columns()) warn(sentence);
    geometry_ = geometry_of(o_, set_->observation().phase_centre);
    warn_of_pointing();
    reach_ = set_->reach();
    if (o_.niter == 0) return;
    clean_ = std::make_unique<CleanStage>(o_, geometry_, threads_);
    if (const std::string warning = clean_->warning(); !warning.empty()) warn(warning);
  }

  void warn_of_pointing() {
    if (o_.phasecenter.empty()) return;
    const std::string warning = pointing_warning(set_->nearest_field(), geometry_, set_->observation().frequency_hz);
    if (!warning.empty()) warn(warning);
  }

  void plan() {
    const bool mask = clean_ && (clean_->mask(0) != nullptr || o_.usemask == "auto");
    const RunScene scene{o_, *set_, geometry_, reach_, threads_, mask};
    plan_ = plan_run(scene, forecast_, times_, progress_);
    for (const std::string& warning : plan_.warnings) warn(warning);
    report_.plan = plan_.decisions;
    report_.estimated_memory_bytes = plan_.memory.total();
    work_ = work_of(scene, plan_);
    source_ = std::make_unique<imager::StreamedVisibilities>(*set_, plan_.streaming);
  }

  std::vector<StageSeconds> expected() const { return expected_seconds(plan_, forecast_, work_); }

  /// A pass over the samples where their weights follow from their density.
  void weigh() {
    const imager::WeightingOptions options = weighting_options(o_);
    if (options.none()) return;
    progress_.begin("weights");
    weights_ = imager::make_imaging_weights(*source_, options, geometry_, threads_, progress(), times_);
    const imager::StageTimer timer(times_, "weights");
    source_->apply(weights_, threads_);
    progress_.end();
  }

  void make_dirty() {
    progress_.begin("dirty image and PSF");
    made_ = imager::make_accurate_images(*source_, plan_.gridding, progress(), times_);
    progress_.end();
    work_.plan = &made_.plan;
    report_.plan.insert(report_.plan.end(), made_.plan.decisions.begin(), made_.plan.decisions.end());
    report_.accuracy = o_.accuracy;
    report_.gridding = &made_.plan;
    count_samples();
    predict_noise();
    const imager::StageTimer timer(times_, "statistics");
    const imager::NeglectedPhase phase = imager::neglected_w_phase(reach_, source_->w_spread(), geometry_);
    for (std::size_t s = 0; s < stokes_.size(); ++s)
      report_.stokes[s].theory =
          imager::theoretical_error(made_.plan, made_.images.sums[s], imager::root_mean_square(made_.images.dirty[s]), phase);
    if (!made_.promise_kept) warn(accuracy_warning(o_.accuracy, std::max(made_.judged_error, largest_expected_error(report_))));
  }

  /// What was read; samples that the pixel size cannot represent, and the pixel size that could.
  void count_samples() {
    const imager::SampleSums& sums = made_.images.sums.front();
    report_.counts = source_->counts();
    report_.counts.outside_grid = sums.outside_grid;
    report_.counts.used = sums.used;
    report_.plan.push_back(left_out_decision(report_.counts));
    if (sums.outside_grid > 0) warn(outside_grid_warning(sums.outside_grid, reach_));
  }

  void predict_noise() {
    const imager::WeightSums sums =
        weights_ ? source_->weight_sums() : imager::WeightSums::of_natural(made_.images.sums.front().weight);
    if (weights_ && !o_.uvtaper.empty() && !sums.outweigh_least(report_.counts.used))
      throw std::runtime_error("--uvtaper " + o_.uvtaper +
                               ": no sample keeps a weight that counts; expected a taper of larger radius in the "
                               "uv plane, or a smaller angle");
    report_.predicted_noise_jy = sums.noise_jy();
    if (weights_) report_.plan.push_back(weights_decision(*weights_, sums));
    weights_.reset();
  }

  void verify() {
    const imager::StageTimer timer(times_, "verify");
    progress_.begin("verify");
    const imager::MeasuredError measured =
        imager::measure_error(*source_, made_.transform->images(), geometry_, made_.images, o_.verify, threads_, progress());
    progress_.end();
    for (std::size_t s = 0; s < stokes_.size(); ++s) report_.stokes[s].measured = measured.image[s];
    report_.measured_predict_rms = measured.predict_rms;
  }

  void choose_beams() {
    const imager::StageTimer timer(times_, "fit beam");
    beams_ = choose_beam(made_.images.psf, geometry_.cell_rad, restoring_beam(o_), o_.niter > 0);
    report_.beams = &beams_;
    for (const std::string& warning : beams_.warnings) warn(warning);
  }

  void begin_products() {
    products_ = std::make_unique<ProductStage>(o_,
                                               ProductScene{geometry_, stokes_, set_->observation(), report_.command_line,
                                                            error_cards(report_), beams_.restoring, threads_},
                                               times_);
    products_->draw_dirty(source_->uv_coverage(), made_.images,
                          [this](std::size_t s) { return clean_ ? clean_->mask(s) : nullptr; });
  }

  void clean() {
    cleaned_.reserve(stokes_.size());  // the report points to what they hold
    for (std::size_t s = 0; s < stokes_.size(); ++s) clean(s);
    clean_.reset();
  }

  void clean(std::size_t s) {
    const std::string of = stokes_.size() > 1 ? " of " + stokes_name(stokes_[s]) : "";
    progress_.begin("CLEAN" + of, true);
    iterations_before_.reset();
    const imager::StokesView view(*source_, static_cast<int>(s));
    cleaned_.push_back(clean_->run(
        {s, view, *made_.transform, made_.images.dirty[s], made_.images.psf, *beams_.main_lobe,
         report_.stokes[s].theory->expected_rms},
        report_.options, progress(),
        [this](const imager::CleanState& state) {
          count_cycle(state.cycles.back());
          if (state.cycles.size() > 1) progress_.say("  " + cycle_message(state));
        },
        times_));
    progress_.end();
    made_.images.dirty[s] = {};
    imager::CleanResult& result = cleaned_.back();
    if (const imager::Image* const mask = clean_->mask(s); mask != nullptr) result.mask = *mask;
    report_.stokes[s].clean = &result.report;
    const imager::CleanStop stop = result.report.stop;
    if (stop == imager::CleanStop::diverging || stop == imager::CleanStop::diverging_from_best)
      warn(divergence_warning(result.report) + of);
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
    const double noise_jy = cleaned_.empty() ? imager::robust_noise(made_.images.dirty.front(), threads_)
                                             : cleaned_.front().report.final_state().rms_jy;
    outside_ = check_outside(*source_, made_.plan, *plan_.wider, made_.images, {noise_jy, !weighting_options(o_).none()},
                             progress(), own);
    progress_.end();
    report_.outside = &outside_;
    imager::Decision told = outside_decision(outside_);
    if (stokes_.size() > 1) told.item += " in " + stokes_name(stokes_.front()) + " alone";
    report_.plan.push_back(told);
    progress_.say(told.item + ": " + told.decision + "; " + told.because);
    for (const std::string& warning : outside_warnings(outside_)) warn(warning);
  }

  /// They make room for the pictures, and are closed before a column is written.
  void release_visibilities() {
    source_.reset();
    set_.reset();
    made_.transform.reset();
  }

  void save_model() {
    progress_.begin("save model", true);  // a column half written helps no one
    const SavedModel model{geometry_, stokes_, cleaned_, report_.options.dump(),
                           [this](const std::string& sentence) { progress_.say(sentence); }};
    tools::save_model(o_, model, threads_, progress());
    progress_.end();
  }

  void write_images() {
    count_pixels();
    std::string removed;
    for (const std::string& path :
         cleaned_.empty() ? products_->write(std::move(made_.images)) : products_->write(std::move(made_.images.psf), cleaned_))
      removed += (removed.empty() ? "" : ", ") + path;
    if (!removed.empty()) progress_.say("removed what an earlier run left: " + removed);
  }

  void count_pixels() {
    const imager::StageTimer timer(times_, "statistics");
    for (std::size_t s = 0; s < stokes_.size(); ++s) {
      const imager::Image& image = cleaned_.empty() ? made_.images.dirty[s] : cleaned_[s].residual;
      const double noise_jy = cleaned_.empty() ? imager::sampled_noise(image) : cleaned_[s].report.final_state().rms_jy;
      report_.stokes[s].histogram = pixel_histogram(image, noise_jy, threads_);
    }
  }

  /// Nothing where gnuplot cannot draw it.
  std::string histogram_drawing() {
    const imager::StageTimer timer(times_, "draw pictures");
    try {
      const PixelHistogram& histogram = report_.stokes.front().histogram;
      return histogram.pixels == 0 ? "" : draw_svg(histogram_figure(histogram));
    } catch (const std::runtime_error&) {  // the pictures say why
      return "";
    }
  }

  void write_report() {
    const std::string histogram = histogram_drawing();
    std::vector<PagePicture> pictures;
    if (const std::string failure = products_->finish_pictures(pictures); !failure.empty()) warn(failure);
    report_.expected = expected();
    const bool one_pass = made_.plan.request.accuracy == o_.accuracy;  // a second asks for more
    if (one_pass) forecast_.learn(work_, times_);
    report_.wall_clock_s = watch_.seconds();
    const nlohmann::json json = report_json(report_);
    write_file(o_.imagename + ".report.json", json.dump(2) + "\n");
    write_file(o_.imagename + ".report.html", report_page(json, pictures, histogram));
  }

  void summarise() const {
    if (!o_.quiet) std::printf("%s%s.report.html\n", summary(report_).c_str(), o_.imagename.c_str());
  }

  const ImageOptions& o_;
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
  std::unique_ptr<CleanStage> clean_;  ///< null without CLEAN, and after it
  RunPlan plan_;
  std::unique_ptr<imager::StreamedVisibilities> source_;
  std::shared_ptr<const imager::ImagingWeights> weights_;  ///< until the noise is predicted; null where they are the data's
  imager::AccurateImages made_;
  BeamChoice beams_;
  OutsideReport outside_;
  std::vector<imager::CleanResult> cleaned_;  ///< [Stokes], or none
  std::unique_ptr<ProductStage> products_;
};

}  // namespace

bool run_image(const ImageOptions& options, const std::string& command_line, const nlohmann::json& option_values) {
  return ImageRun(options, command_line, option_values).run();
}

}  // namespace misfit::tools
