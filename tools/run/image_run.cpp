#include "tools/run/image_run.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "imager/noise.h"
#include "imager/parallel.h"
#include "tools/base/files.h"
#include "tools/base/left_out.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/base/progress.h"
#include "tools/base/quantity.h"
#include "tools/formats/model_image.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/run/beam_choice.h"
#include "tools/run/clean_stage.h"
#include "tools/run/memory_plan.h"
#include "tools/run/product_stage.h"
#include "tools/run/run_report.h"
#include "tools/run/time_forecast.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {
namespace {

/// One run of `misfit image`, from options to files. The steps are called in the order in which they stand here.
class ImageRun {
 public:
  ImageRun(const ImageOptions& options, std::string command_line, nlohmann::json option_values)
      : o_(options), threads_(options.threads == 0 ? imager::available_threads() : options.threads), progress_(options.quiet) {
    report_.command_line = std::move(command_line);
    report_.options = std::move(option_values);
    report_.times = &times_;
  }

  /// Whether all was done, and the user did not stop it.
  bool run() {
    open();
    plan();
    forecast();
    if (o_.dry_run) {
      print_plan();
      return true;
    }
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
    return !cleaned_ || cleaned_->report.stop != imager::CleanStop::user;
  }

 private:
  imager::Progress progress() {
    return [this](std::uint64_t done, std::uint64_t total) { progress_.update(done, total); };
  }
  void decide(const std::string& item, const std::string& decision, const std::string& because) {
    report_.plan.push_back({item, decision, because});
  }
  void warn(const std::string& sentence) {
    report_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }

  void open() {
    const imager::StageTimer timer(times_, "open");
    if (!o_.dry_run) check_writable_folder(o_.imagename);
    if (o_.savemodel == "modelcolumn") ms_io::require_writable(o_.vis);
    set_ = std::make_unique<ms_io::MeasurementSet>(o_.vis, o_.selection, o_.datacolumn);
    geometry_ = geometry_of(o_, set_->observation().phase_centre);
    reach_ = set_->reach();
    if (o_.niter == 0) return;
    clean_ = std::make_unique<CleanStage>(o_, geometry_, threads_);
    if (const std::string warning = clean_->warning(); !warning.empty()) warn(warning);
  }

  /// All that is decided before a visibility is read.
  void plan() {
    const imager::StageTimer timer(times_, "plan");
    imager::GriddingRequest request = gridding_request(o_, threads_);
    request.geometry = geometry_;
    request.samples = set_->samples();
    request.max_abs_w = reach_.max_abs_w;
    if (o_.memory_gib > 0) limit_memory(o_.memory_gib * gib, request);
    made_.plan = imager::plan_gridding(request);
    decide_pixels();
    if (o_.check_outside) plan_search(request);
    MemoryPlan memory = plan_memory({.transform = imager::memory_of(made_.plan),
                                     .pixels = static_cast<double>(geometry_.pixels()),
                                     .rows = static_cast<double>(set_->rows()),
                                     .samples = static_cast<double>(set_->samples()),
                                     .block_samples = static_cast<double>(ms_io::MeasurementSet::usual_block_samples),
                                     .verify = o_.verify > 0,
                                     .clean = o_.niter > 0,
                                     .mask = clean_ && (clean_->mask() != nullptr || o_.usemask == "auto"),
                                     .start_model = !o_.startmodel.empty(),
                                     .wider = wider_demand()},
                                    o_);
    memory.streaming.uv_reach_lambda = std::min(std::max(reach_.max_abs_u, reach_.max_abs_v), 0.5 / geometry_.cell_rad);
    memory_ = memory.peak;
    report_.estimated_memory_bytes = memory_.total();
    source_ = std::make_unique<imager::StreamedVisibilities>(*set_, memory.streaming);
    report_.plan.push_back(memory.decision);
    decide("columns and correlations", "only what Stokes I needs",
           "UVW, antennas, flags, weights and one data column, each read once");
    if (o_.niter > 0)
      decide("PSF patch", "none, the whole PSF", "components are subtracted to the image's edges in every minor cycle");
    warn_of_neglected_w();
  }

  /// Of sources outside, by what is known before a visibility is read.
  void plan_search(const imager::GriddingRequest& request) {
    imager::WideFieldFinder finder(geometry_);
    set_->visit_coordinates([&](const imager::SampleCoordinates& some) { finder.add(some); });
    wide_field_ = finder.field();
    wider_ = std::make_unique<imager::GriddingPlan>(imager::plan_wide_field(wide_field_, request));
  }

  std::optional<imager::WiderDemand> wider_demand() const {
    if (!wider_) return {};
    return imager::WiderDemand{imager::memory_of(*wider_), static_cast<double>(wide_field_.geometry.pixels())};
  }

  double expected_search_s() const {
    for (const StageSeconds& s : forecast_.expected(work_))
      if (s.stage == "sources outside") return s.seconds;
    return 0;
  }

  void decide_pixels() {
    const ScaledUnit unit = angle_unit(geometry_.cell_rad);
    const std::string cell = significant(geometry_.cell_rad / unit.size, 6) + " " + unit.name;
    const bool told = has_unit(o_.cell);
    const std::string because = "--cell " + o_.cell + (told ? "" : " has no unit, and is in arcsec as in tclean");
    decide("pixels", std::to_string(geometry_.width) + " × " + std::to_string(geometry_.height) + " of " + cell, because);
    if (!told) progress_.say(because);
  }

  /// Of all stages, what was spent before the forecast among them.
  std::vector<StageSeconds> expected(const RunWork& work) const {
    std::vector<StageSeconds> stages = spent_;
    for (const StageSeconds& s : forecast_.expected(work)) stages.push_back(s);
    return stages;
  }

  /// How long it will take; of CLEAN, whose cycles nobody knows beforehand, what each of them takes.
  void forecast() {
    work_ = {.plan = &made_.plan,
             .rows = static_cast<double>(set_->rows()),
             .samples = static_cast<double>(set_->samples()),
             .pixels = static_cast<double>(geometry_.pixels()),
             .images = o_.niter > 0 ? 4 : 2,
             .pictures = o_.niter > 0 ? 6 : 3,
             .threads = threads_,
             .verified = static_cast<double>(o_.verify),
             .deconvolver = o_.deconvolver,
             .wider = wider_.get()};
    for (const auto& [stage, seconds] : times_.stages()) spent_.push_back({stage, "", seconds});
    if (wider_) report_.plan.push_back(search_decision(wide_field_, expected_search_s()));
    const double all_s = total_seconds(expected(work_));
    decide("expected time", duration(all_s) + (o_.niter > 0 ? " without CLEAN" : ""),
           forecast_.knows(work_) ? "from counts of operations, and what earlier runs took on this machine"
                                  : "from counts of operations; not all of them were timed on this machine before");
    if (o_.niter == 0) return;
    RunWork one = work_;
    one.components = std::min(o_.niter, 1000);
    one.major_cycles = 1;
    decide("expected time of a major cycle", duration(total_seconds(expected(one)) - all_s),
           "with " + grouped(static_cast<long long>(one.components)) + " components");
  }

  void warn_of_neglected_w() {
    const double phase_rad = imager::max_w_phase_rad(reach_.max_abs_w, geometry_);
    const bool harms = phase_rad > (o_.accuracy == 0 ? made_.plan.worst_error : o_.accuracy);
    if (!made_.plan.options.has_w_axis() && harms)
      warn("w is neglected although its phase reaches " + significant(phase_rad, 2) +
           " rad at the image's corner: the image's error there is of that size");
  }

  void print_plan() {
    if (o_.quiet) return;
    report_.plan.insert(report_.plan.end(), made_.plan.decisions.begin(), made_.plan.decisions.end());
    for (const imager::Decision& d : report_.plan)
      std::printf("%s: %s; %s\n", d.item.c_str(), d.decision.c_str(), d.because.c_str());
    for (const StageSeconds& s : expected(work_))
      std::printf("expected: %-16s %s\n", s.stage.c_str(), duration(s.seconds).c_str());
    std::printf("expected: %-16s %s\n", "total", duration(total_seconds(expected(work_))).c_str());
    std::printf("%s", memory_table(memory_).c_str());
  }

  void make_dirty() {
    progress_.begin("dirty image and PSF");
    made_ = imager::make_accurate_images(*source_, std::move(made_.plan), progress(), times_);
    progress_.end();
    report_.plan.insert(report_.plan.end(), made_.plan.decisions.begin(), made_.plan.decisions.end());
    report_.accuracy = o_.accuracy;
    report_.gridding = &made_.plan;
    count_samples();
    const imager::StageTimer timer(times_, "statistics");
    const imager::NeglectedPhase phase = imager::neglected_w_phase(reach_, source_->w_spread(), geometry_);
    theory_ = imager::theoretical_error(made_.plan, made_.images.sums, imager::root_mean_square(made_.images.dirty), phase);
    report_.theory = &theory_;
    if (!made_.promise_kept)
      warn("the accuracy of " + significant(o_.accuracy, 2) +
           " is out of reach: the image is weak against its data, and its expected error is " +
           significant(theory_.expected_rms, 2));
  }

  /// What was read; samples that the pixel size cannot represent, and the pixel size that could.
  void count_samples() {
    const imager::SampleSums& sums = made_.images.sums;
    report_.counts = source_->counts();
    report_.counts.outside_grid = sums.outside_grid;
    report_.counts.used = sums.used;
    decide("samples left out", left_out_of_all(report_.counts), left_out_reasons(report_.counts));
    if (sums.outside_grid == 0) return;
    const double reach = std::max(reach_.max_abs_u, reach_.max_abs_v);
    const ScaledUnit unit = angle_unit(0.5 / reach);
    warn(grouped(static_cast<long long>(sums.outside_grid)) + " samples lie beyond 1/(2 cell) and were left out; a cell of " +
         significant(std::floor(0.5 / reach / unit.size * 1e4) / 1e4, 4) + unit.name + " would keep them");
  }

  void verify() {
    const imager::StageTimer timer(times_, "verify");
    progress_.begin("verify");
    measured_ =
        imager::measure_error(*source_, made_.transform->images(), geometry_, made_.images, o_.verify, threads_, progress());
    progress_.end();
    report_.measured = &measured_;
  }

  void choose_beams() {
    const imager::StageTimer timer(times_, "fit beam");
    beams_ = choose_beam(made_.images.psf, geometry_.cell_rad, restoring_beam(o_), o_.niter > 0);
    report_.beams = &beams_;
    for (const std::string& warning : beams_.warnings) warn(warning);
  }

  void begin_products() {
    products_ = std::make_unique<ProductStage>(
        o_,
        ProductScene{geometry_, set_->observation(), report_.command_line, error_cards(report_), beams_.restoring, threads_},
        times_);
    products_->draw_dirty(source_->uv_coverage(), made_.images, clean_ ? clean_->mask() : nullptr);
  }

  void clean() {
    progress_.begin("CLEAN", true);
    cleaned_ = std::make_unique<imager::CleanResult>(clean_->run(
        {*source_, *made_.transform, made_.images, *beams_.main_lobe, theory_.expected_rms}, report_.options, progress(),
        [this](const imager::CleanState& state) {
          const imager::MajorCycle& cycle = state.cycles.back();
          count_cycle(cycle);
          if (state.cycles.size() > 1)
            progress_.say("  " + grouped(cycle.iterations) + " components, peak residual " + flux(cycle.peak_residual_jy) +
                          ", noise " + flux(cycle.rms_jy) + (state.now + 1 == state.cycles.size() ? "" : ": taken back"));
        },
        times_));
    progress_.end();
    made_.images.dirty = {};
    if (clean_->mask() != nullptr) cleaned_->mask = *clean_->mask();
    clean_.reset();
    report_.clean = &cleaned_->report;
    const imager::CleanStop stop = cleaned_->report.stop;
    if (stop == imager::CleanStop::diverging || stop == imager::CleanStop::diverging_from_best)
      warn("CLEAN diverged: a lower --gain, a --mask around the sources, or more scales may help; the largest sidelobe is " +
           significant(100 * cleaned_->report.max_sidelobe, 2) + " % of the PSF's peak");
  }

  /// Told of the state with which CLEAN begins, which may be that of a run before, and after every major cycle.
  void count_cycle(const imager::MajorCycle& cycle) {
    if (!iterations_before_) {
      iterations_before_ = cycle.iterations;
      return;
    }
    ++work_.major_cycles;
    work_.components = cycle.iterations - *iterations_before_;
  }

  void look_outside() {
    const imager::StageTimer timer(times_, "sources outside");
    imager::StageTimes own;  // its gridding is not this image's
    progress_.begin("sources outside", true);
    const double noise_jy =
        cleaned_ ? cleaned_->report.final_state().rms_jy : imager::robust_noise(made_.images.dirty, threads_);
    outside_ = check_outside(*source_, made_.plan, *wider_, made_.images, noise_jy, progress(), own);
    progress_.end();
    report_.outside = &outside_;
    const imager::Decision told = outside_decision(outside_);
    decide(told.item, told.decision, told.because);
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
    ModelVisibilities model;
    {
      const ms_io::MeasurementSet set(o_.vis, o_.selection, o_.datacolumn);
      model = image_visibilities(cleaned_->model, geometry_, gridding_request(o_, threads_), set);
    }
    ms_io::write_model(o_.vis, o_.selection, {"MODEL_DATA"}, model.predict, progress(), model.samples_at_once);
    progress_.end();
  }

  void write_images() {
    count_pixels();
    std::string removed;
    for (const std::string& path :
         cleaned_ ? products_->write(std::move(made_.images.psf), *cleaned_) : products_->write(std::move(made_.images)))
      removed += (removed.empty() ? "" : ", ") + path;
    if (!removed.empty()) progress_.say("removed what an earlier run left: " + removed);
  }

  void count_pixels() {
    const imager::StageTimer timer(times_, "statistics");
    report_.histogram = cleaned_ ? pixel_histogram(cleaned_->residual, cleaned_->report.final_state().rms_jy, threads_)
                                 : pixel_histogram(made_.images.dirty, imager::sampled_noise(made_.images.dirty), threads_);
  }

  /// Nothing where gnuplot cannot draw it.
  std::string histogram_drawing() {
    const imager::StageTimer timer(times_, "draw pictures");
    try {
      return report_.histogram.pixels == 0 ? "" : draw_svg(histogram_figure(report_.histogram));
    } catch (const std::runtime_error&) {  // the pictures say why
      return "";
    }
  }

  void write_report() {
    const std::string histogram = histogram_drawing();
    std::vector<PagePicture> pictures;
    if (const std::string failure = products_->finish_pictures(pictures); !failure.empty()) warn(failure);
    report_.expected = expected(work_);
    const bool one_pass = made_.plan.request.accuracy == o_.accuracy;  // a second asks for more
    if (one_pass) forecast_.learn(work_, times_);
    report_.wall_clock_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const nlohmann::json json = report_json(report_);
    write_file(o_.imagename + ".report.json", json.dump(2) + "\n");
    write_file(o_.imagename + ".report.html", report_page(json, pictures, histogram));
  }

  static std::string flux(double jy) {
    const ScaledUnit unit = scaled_unit(jy, "Jy/beam");
    return significant(jy / unit.size, 3) + " " + unit.name;
  }

  void summarise() const {
    if (o_.quiet) return;
    std::printf("%s of %s samples imaged; expected error %s", grouped(static_cast<long long>(report_.counts.used)).c_str(),
                grouped(static_cast<long long>(report_.counts.samples_read)).c_str(),
                significant(theory_.expected_rms, 2).c_str());
    if (report_.measured != nullptr)
      std::printf(", measured %s (prediction %s)", significant(measured_.rms, 2).c_str(),
                  significant(measured_.predict_rms, 2).c_str());
    std::printf("\n");
    if (cleaned_)
      std::printf("%s components, model flux %s; %s\n", grouped(cleaned_->report.iterations).c_str(),
                  significant(cleaned_->report.final_state().model_flux_jy, 4).c_str(), cleaned_->report.stop_reason.c_str());
    std::printf("%s.report.html\n", o_.imagename.c_str());
  }

  const ImageOptions& o_;
  int threads_;
  ProgressLine progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  imager::StageTimes times_;
  RunReport report_;
  TimeForecast forecast_{default_cache_folder()};
  RunWork work_;
  std::optional<int> iterations_before_;  ///< this run's CLEAN
  std::vector<StageSeconds> spent_;       ///< on stages before the forecast

  std::unique_ptr<ms_io::MeasurementSet> set_;
  imager::ImageGeometry geometry_;
  imager::UvwReach reach_;
  std::unique_ptr<CleanStage> clean_;  ///< null without CLEAN, and after it
  std::unique_ptr<imager::StreamedVisibilities> source_;
  imager::MemoryUse memory_;
  imager::WideField wide_field_;
  std::unique_ptr<imager::GriddingPlan> wider_;  ///< of the field to search for sources outside; null without
  imager::AccurateImages made_;
  imager::TheoreticalError theory_;
  imager::MeasuredError measured_;
  BeamChoice beams_;
  OutsideReport outside_;
  std::unique_ptr<imager::CleanResult> cleaned_;
  std::unique_ptr<ProductStage> products_;
};

}  // namespace

bool run_image(const ImageOptions& options, const std::string& command_line, const nlohmann::json& option_values) {
  return ImageRun(options, command_line, option_values).run();
}

}  // namespace misfit::tools
