#include "tools/run/cube_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "imager/numerics/parallel.h"
#include "tools/base/files.h"
#include "tools/base/interrupt.h"
#include "tools/base/json_text.h"
#include "tools/base/numbers.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/run/changed_files.h"
#include "tools/run/cube_pictures.h"
#include "tools/run/cube_planes.h"
#include "tools/run/cube_turns.h"
#include "tools/run/cube_visibilities.h"
#include "tools/run/data_columns.h"
#include "tools/run/image_files.h"
#include "tools/run/primary_beam_stage.h"
#include "tools/run/product_stage.h"
#include "tools/run/run_messages.h"
#include "tools/run/run_plan.h"
#include "tools/run/set_notes.h"
#include "tools/run/sharing.h"
#include "tools/run/weighting_options.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {
namespace {

/// One run, from options to files. The steps are called in the order in which they stand here. Ranks make planes in turns; the
/// first puts them together, and writes.
class CubeRun {
 public:
  CubeRun(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks)
      : o_(options),
        ranks_(ranks),
        stokes_(imager::parse_stokes(options.stokes)),
        threads_(options.threads == 0 ? imager::available_threads(ranks.on_these_cores()) : options.threads),
        progress_(options.quiet || !ranks.first()) {
    report_.command_line = call.command_line;
    report_.options = call.option_values;
    report_.times = &times_;
    report_.planes.clear();
  }

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
    begin_planes();
    if (!o_.cube.perchanweightdensity) weigh_in_common();
    make_planes();
    count_samples();
    count_traffic();
    if (ranks_.first()) {
      finish_files();
      write_report();
      if (!o_.quiet) std::printf("%s%s.report.html\n", summary(report_).c_str(), o_.imagename.c_str());
    }
    bool done = !stopped_;
    imager::share_values(ranks_, done);
    return done;
  }

  void warn(const std::string& sentence) {
    report_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }
  int planes() const { return header_.spectral.channels; }
  int planes_of_a_rank() const { return (planes() + ranks_.size() - 1) / ranks_.size(); }

  void open() {
    const imager::StageTimer timer(times_, "open");
    if (!o_.dry_run && ranks_.first()) name_ = claim_product_paths(o_);
    set_ = std::make_unique<ms_io::MeasurementSet>(o_.vis, selection_of(o_), o_.datacolumn, stokes_);
    windows_ = set_->spectral_windows();
    sampling_ = cube_sampling(o_.cube, windows_);
    if (const std::string words = windows_left_out(sampling_.axis, windows_); !words.empty()) warn(words);
    header_ = {.geometry = geometry_of(o_, set_->observation().phase_centre),
               .observation = set_->observation(),
               .spectral = sampling_.axis,
               .stokes = stokes_,
               .cards = {},
               .history = history_of(report_.command_line, set_->data_columns())};
    report_.cube = sampling_.axis;
    notes_ = notes_on_sets(o_, *set_, header_.geometry);
    for (const std::string& warning : notes_.warnings) warn(warning);
    if (o_.niter > 0)  // so that what is wrong with masks and models is said at once
      for (const std::string& words : CleanStage(o_, header_, threads_).words_on_files()) warn(words);
    if (wants_primary_beam(o_))
      primary_beam_ = std::make_unique<PrimaryBeamStage>(
          o_, BeamScene{set_->beam_rows(), header_.geometry, set_->observation().frequency_hz},
          std::max(1, threads_ / planes_of_a_rank()));
    find_reach();
  }

  /// Planes may lie half a channel beyond the data's last.
  void find_reach() {
    reach_ = ranks_.alone() ? set_->reach() : set_->share(ranks_)->reach();
    double beyond = 0;
    for (const ms_io::SpectralWindow& window : windows_)
      for (std::size_t c = 0; c < window.frequency_hz.size(); ++c)
        beyond = std::max(beyond, 0.5 * window.channel_width_hz[c] / window.frequency_hz[c]);
    for (double* reach : {&reach_.max_abs_u, &reach_.max_abs_v, &reach_.max_abs_w}) *reach *= 1 + beyond;
  }

  void plan() {
    const double enlarged = o_.scale.enlarged(static_cast<double>(set_->samples()));
    const RunScene scene{.options = o_,
                         .set = *set_,
                         .ranks = ranks_,
                         .geometry = header_.geometry,
                         .reach = reach_,
                         .threads = threads_,
                         .mask = o_.niter > 0 && (!o_.mask.empty() || o_.usemask == "auto"),
                         .planes = planes(),
                         .workers = std::min(threads_, planes_of_a_rank()),
                         .samples = enlarged * static_cast<double>(set_->rows()) * samples_of_a_row(sampling_, windows_),
                         .enlarged = enlarged};
    plan_ = plan_run(scene, times_, progress_);
    plan_.decisions.push_back(axis_decision(sampling_));
    plan_.decisions.insert(plan_.decisions.end(), notes_.decisions.begin(), notes_.decisions.end());
    if (primary_beam_) {
      plan_.decisions.push_back(primary_beam_->decision());
      for (const std::string& doubt : primary_beam_->doubts()) warn(doubt);
    }
    const CubeBatches batches = plan_batches(scene, plan_);
    turns_ = std::make_unique<CubeTurns>(ranks_, batches_of(planes(), batches));
    workers_ = batches.workers;
    at_once_ = workers_.count;
    imager::sum_over(ranks_, at_once_);
    if (!ranks_.alone())
      plan_.decisions.push_back(
          plane_sharing_decision(ranks_.size(), planes(), batches.planes, plane_bytes(work_of(scene, plan_))));
    plan_.gridding = imager::with_threads(std::move(plan_.gridding), workers_.threads);
    plan_.memory = batches.memory;
    plan_.decisions.push_back(batches.decision);
    work_ = work_of(scene, plan_);
    work_.workers = at_once_;
    work_.kept = !batches.read_again;
    foretell(scene, forecast_, work_, times_, plan_);
    visibilities_ = std::make_unique<CubeVisibilities>(*set_, sampling_, batches, threads_, o_.niter > 0);
    for (const std::string& warning : plan_.warnings) warn(warning);
    report_.plan = plan_.decisions;
    report_.plan.insert(report_.plan.end(), plan_.gridding.decisions.begin(), plan_.gridding.decisions.end());
    report_.accuracy = o_.accuracy;
    report_.gridding = &plan_.gridding;
    report_.estimated_memory_bytes = plan_.memory.total();
    const imager::StageTimer timer(times_, "plan");
    if (!o_.dry_run) transform_ = std::make_shared<imager::PlannedTransform>(plan_.gridding);
  }

  std::vector<StageSeconds> expected() const { return expected_seconds(plan_, forecast_, work_); }

  void begin_planes() {
    const imager::StageTimer timer(times_, "write images");
    const auto open = [this](const std::string& name, const imager::ImageHeader& header) {
      return turns_->open([&] { return open_image_files(name, header, pixel_format(o_.accuracy), o_.outformat); });
    };
    planes_ = std::make_unique<CubePlanes>(
        CubeScene{o_, report_.options, header_, reach_, plan_.gridding, transform_, workers_, primary_beam_.get(), open});
  }

  /// From the density of all planes' samples together.
  void weigh_in_common() {
    const imager::WeightingOptions options = weighting_options(o_);
    if (!options.needs_density()) return;
    imager::UvDensity density(header_.geometry, threads_);
    const auto add = [&](const imager::VisibilitySource& plane) {
      const imager::StageTimer timer(times_, "weights");
      const auto stream = plane.open();
      while (const auto block = stream->next()) density.add(*block);
    };
    visibilities_->look_through(turns_->own_batches(), add, progress_, times_);
    if (!ranks_.alone()) density.add_up(ranks_);
    planes_->weigh_by(std::make_shared<imager::ImagingWeights>(density, options));
  }

  void make_planes() {
    const auto take = [this](CubePlane&& plane) { this->take(std::move(plane)); };
    stopped_ = turns_->make(*visibilities_, *planes_, take, progress_, times_);
    if (ranks_.first() && stopped_ && report_.planes.empty()) throw Interrupted();
  }

  /// The next plane, of several threads' one at a time.
  void take(CubePlane&& plane) {
    for (const std::string& sentence : plane.warnings) warn(sentence);
    for (const std::string& doubt : plane.doubts) doubts_[doubt].push_back(plane.report.channel);
    for (const auto& [stage, seconds] : plane.times.stages()) times_.add(stage, seconds / at_once_);
    outside_grid_ += plane.outside_grid;
    work_.components += plane.components;
    work_.major_cycles += plane.major_cycles;
    empty_ += plane.empty() ? 1 : 0;
    report_.plane_samples += plane.report.sums.used;
    if (o_.niter > 0 && !plane.empty()) progress_.say(plane_message(plane.report, planes()));
    report_.planes.push_back(std::move(plane.report));
  }

  /// Each sample read once: what is left out for no reason is used. Of those that planes take, as large a part is outside the
  /// grid as of the planes' samples.
  void count_samples() {
    imager::SampleCounts& counts = report_.counts = visibilities_->counts();
    report_.outside_planes = visibilities_->outside_planes();
    counts.add_up(ranks_);
    imager::sum_over(ranks_, report_.outside_planes);
    const std::uint64_t taken = counts.samples_read - counts.autocorrelations - counts.flagged - counts.nonfinite -
                                counts.zero_weight - report_.outside_planes;
    const double in_planes = static_cast<double>(outside_grid_ + report_.plane_samples);
    if (outside_grid_ > 0)
      counts.outside_grid =
          static_cast<std::uint64_t>(std::ceil(static_cast<double>(taken) * (static_cast<double>(outside_grid_) / in_planes)));
    counts.used = taken - counts.outside_grid;
    for (const std::string& warning : notes_on_data(*set_, ranks_)) warn(warning);
  }

  void count_traffic() {
    if (ranks_.alone()) return;
    imager::Traffic all = ranks_.traffic();
    imager::sum_over(ranks_, all.bytes, all.exchanges);
    report_.plan.push_back(plane_traffic_decision(all));
  }

  void finish_files() {
    if (report_.planes.size() == empty_) throw_nothing();
    std::string removed;
    for (const std::string& path : planes_->products().finish(report_.planes, error_cards(report_), times_))
      removed += (removed.empty() ? "" : ", ") + path;
    if (!removed.empty()) progress_.say("removed what an earlier run left: " + removed);
    report_.plan.push_back(left_out_decision(report_.counts));
    if (const std::string warning = changed_files_warning(*set_); !warning.empty()) warn(warning);
    if (outside_grid_ > 0) warn(outside_grid_warning(report_.counts.outside_grid, reach_));
    for (const auto& [doubt, planes] : doubts_)
      warn((planes.size() > 1 ? "planes " : "plane ") + in_runs(planes) + ": " + doubt);
    if (empty_ > 0)
      warn(std::to_string(empty_) + " of " + std::to_string(planes()) +
           " planes have no samples: they have no values and no beam");
    if (const std::size_t left = static_cast<std::size_t>(planes()) - report_.planes.size(); left > 0)
      warn("stopped by the user: " + std::to_string(left) + " of " + std::to_string(planes()) + " planes have no values");
  }

  [[noreturn]] void throw_nothing() const {
    if (outside_grid_ > 0) throw imager::NothingInGrid(outside_grid_);
    throw imager::NothingUsable(report_.counts);
  }

  void write_report() {
    report_.shown = brightest_plane(report_.planes);
    {
      const imager::StageTimer timer(times_, "statistics");
      count_pixels(o_, report_.planes[report_.shown], threads_);
    }
    CubeDrawings drawn;
    {
      const imager::StageTimer timer(times_, "draw pictures");
      drawn = draw_cube(o_, header_, report_);
      if (!drawn.failure.empty()) warn(drawn.failure);
    }
    for (const imager::Decision& d : report_.planes[report_.shown].decisions)
      report_.plan.push_back(
          {d.item + " of plane " + std::to_string(report_.planes[report_.shown].channel), d.decision, d.because});
    report_.expected = expected();
    const auto made_twice = [](const PlaneReport& plane) { return plane.made_twice; };
    if (std::none_of(report_.planes.begin(), report_.planes.end(), made_twice)) forecast_.learn(work_, times_);
    report_.wall_clock_s = watch_.seconds();
    const nlohmann::json json = report_json(report_);
    write_file(o_.imagename + ".report.json", json_text(json, 2) + "\n");
    write_file(o_.imagename + ".report.html", report_page(json, drawn.pictures, {"", drawn.spectrum}));
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

  std::unique_ptr<ms_io::MeasurementSet> set_;
  std::vector<ms_io::SpectralWindow> windows_;
  imager::CubeSampling sampling_;
  imager::ImageHeader header_;
  imager::UvwReach reach_;
  FieldNotes notes_;
  RunPlan plan_;
  std::unique_ptr<CubeVisibilities> visibilities_;
  std::shared_ptr<const imager::PlannedTransform> transform_;
  PlaneWorkers workers_;
  int at_once_ = 1;                                 ///< planes that all ranks make at a time
  std::unique_ptr<PrimaryBeamStage> primary_beam_;  ///< null where none is wanted
  std::unique_ptr<CubeTurns> turns_;
  std::unique_ptr<CubePlanes> planes_;
  std::uint64_t outside_grid_ = 0;
  std::size_t empty_ = 0;  ///< planes
  bool stopped_ = false;
  std::map<std::string, std::vector<int>> doubts_;  ///< with the planes of which they are
};

}  // namespace

bool run_cube(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks) {
  return CubeRun(options, call, ranks).run();
}

}  // namespace misfit::tools
