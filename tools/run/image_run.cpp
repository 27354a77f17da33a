#include "tools/run/image_run.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "imager/data/noise.h"
#include "imager/data/stokes.h"
#include "imager/numerics/page_pool.h"
#include "imager/numerics/parallel.h"
#include "ms_io/model_writer.h"
#include "ms_io/room.h"
#include "tools/base/files.h"
#include "tools/base/interrupt.h"
#include "tools/base/json_text.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/progress.h"
#include "tools/formats/image_file.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/run/changed_files.h"
#include "tools/run/channel_maker.h"
#include "tools/run/channel_queue.h"
#include "tools/run/channel_tally.h"
#include "tools/run/data_columns.h"
#include "tools/run/image_files.h"
#include "tools/run/left_over.h"
#include "tools/run/model_stage.h"
#include "tools/run/mosaic_stage.h"
#include "tools/run/outside_stage.h"
#include "tools/run/phased_set.h"
#include "tools/run/pixel_plan.h"
#include "tools/run/products.h"
#include "tools/run/run_messages.h"
#include "tools/run/run_plan.h"
#include "tools/run/run_report.h"
#include "tools/run/set_notes.h"
#include "tools/run/sharing.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"
#include "tools/run/written_column.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {
namespace {

/// One run of `misfit image`, from options to files: a list of channels, which is one for the whole band, or those of a cube.
/// The steps are called in the order in which they stand here. All ranks make the one channel together, each with a part of the
/// samples; of a cube's channels each rank makes some. The first rank puts them together, and writes.
class ImageRun : private ChannelSink {
 public:
  ImageRun(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks)
      : o_(options),
        call_(call),
        ranks_(ranks),
        sharing_(ranks, options.cube.is_cube()),
        stokes_(imager::parse_stokes(options.stokes)),
        threads_(options.threads == 0 ? imager::available_threads(ranks.on_these_cores()) : options.threads),
        progress_(options.quiet || !ranks.first()) {
    imager::PagePool::fill_by(threads_);
    report_.command_line = call.command_line;
    report_.options = call.option_values;
    report_.times = &times_;
    report_.channels.clear();
  }

  Outcome run() {
    try {
      take_steps();
      return std::move(outcome_);
    } catch (const std::runtime_error&) {
      rethrow_with_changed_files(ranks_.first() ? set_.get() : nullptr);
    }
  }

 private:
  void take_steps() {
    open();
    plan();
    if (o_.dry_run) return tell_plan();
    begin_channels();
    if (cube() && !o_.cube.perchanweightdensity) weigh_in_common();
    try {
      make_channels();
      maker_.reset();
      if (cube()) count_samples();
      if (!ranks_.alone()) report_.plan.push_back(sharing_.traffic_decision(times_));
      if (ranks_.first()) finish_products();
    } catch (const imager::NothingInGrid& nothing) {
      throw std::runtime_error(std::string(nothing.what()) + ": " + keeping_cell_words(reach_));
    }
    if (ranks_.first()) write_report();
    const std::string saved = o_.clean.savemodel == "modelcolumn" ? save_model() : "";
    if (ranks_.first()) outcome_.words = summary(report_) + saved + o_.imagename + ".report.html\n";
    outcome_.complete = !queue_->stopped();
    imager::share_values(ranks_, outcome_.complete);
  }

  void tell_plan() {
    if (leaves_grid(reach_, header_.geometry)) warn(outside_grid_forecast(reach_));
    const std::vector<StageSeconds> seconds = expected();
    outcome_.words = plan_text(plan_, seconds);
    report_.plan.insert(report_.plan.end(), plan_.gridding.decisions.begin(), plan_.gridding.decisions.end());
    report_.expected = seconds;
    outcome_.report = plan_json(report_);
  }

  void warn(const std::string& sentence) {
    report_.warnings.push_back(sentence);
    progress_.say("warning: " + sentence);
  }

  bool cube() const { return o_.cube.is_cube(); }
  int channels() const { return header_.spectral.channels; }

  void open() {
    const imager::StageTimer timer(times_, imager::stage::open);
    sharing_.require_same(call_.option_values);
    if (!o_.dry_run && ranks_.first()) name_ = claim_product_paths(o_);
    if (o_.clean.savemodel == "modelcolumn" && ranks_.first())
      for (const std::string& set : o_.vis) ms_io::require_writable(set);
    open_set();
    if (is_mosaic(o_, *set_)) {
      o_.gridding.gridder = "mosaic";
      progress_.say("fields point apart: --gridder mosaic");
      open_set();
    }
    if (!o_.makes_mosaic()) refuse_beside_other_gridders(o_.mosaic);
    refuse_outside_of_mosaic(o_);
    if (auto own = sharing_.own_part(*set_)) set_ = std::move(own);
    if (o_.clean.savemodel != "none")
      if (const std::string words = left_out_of_model_warning(stokes_, *set_); !words.empty()) warn(words);
    if (o_.clean.savemodel == "modelcolumn" && ranks_.first()) warn_of_unselected();
    windows_ = set_->spectral_windows();
    header_ = {.geometry = geometry_of(o_, set_->observation().phase_centre),
               .observation = set_->observation(),
               .spectral = list_channels(),
               .stokes = stokes_,
               .cards = {},
               .history = {}};
    notes_ = notes_on_sets(o_, *set_, header_.geometry);
    for (const std::string& warning : notes_.warnings) warn(warning);
    if (!o_.makes_mosaic() && (o_.primary_beam.wanted() || o_.measures_noise_in_beam())) find_primary_beam();
    if (o_.clean.runs() && sharing_.images_here()) open_clean();
    if (o_.taken.any()) taken_ = std::make_unique<TakenFiles>(o_, header_);
    header_.history = history_of(report_.command_line, set_->data_columns());
    if (o_.taylor.nterms > 1) header_.observation.frequency_hz = taylor_expansion(o_.taylor, set_->observation()).reference_hz;
    if (!cube()) header_.spectral = whole_band(header_.observation);
    find_reach();
    if (o_.makes_mosaic()) begin_mosaic();
  }

  void open_set() {
    ms_io::Selection selection = selection_of(o_);
    if (o_.makes_mosaic() && o_.mosaic.usepointing) {
      selection.sights = false;
      const ms_io::MeasurementSet by_field(o_.vis, selection, "");
      selection = selection_of(o_);
      selection.pointing_tolerance_rad = pointing_tolerance_rad(o_, by_field);
    }
    set_ = std::make_unique<ms_io::MeasurementSet>(o_.vis, selection, o_.datacolumn, stokes_);
  }

  void begin_mosaic() {
    if (o_.mosaic.usepointing && o_.clean.savemodel != "none")
      refuse_option("savemodel", o_.clean.savemodel, "none beside --usepointing: models are predicted where FIELD says");
    mosaic_ = mosaic_stage(o_, *set_, header_.geometry, reach_.max_abs_w);
    for (const std::string& warning : mosaic_.warnings) warn(warning);
    if (!o_.taken.any()) return;
    o_.taken = {};  // files are looked at all the same
    mosaic_.decisions.push_back(
        {"PSF and residual", "made again", "those that there are of a mosaic are not compared with its samples"});
  }

  void find_primary_beam() {
    BeamScene scene{set_->beam_rows(), header_.geometry, set_->observation().frequency_hz,
                    [this] { return set_->zenith_turns(); }};
    try {
      primary_beam_ = std::make_unique<PrimaryBeamStage>(o_.primary_beam, std::move(scene),
                                                         std::max(1, threads_ / sharing_.channels_here(channels())));
    } catch (const NoPrimaryBeam& none) {
      if (o_.primary_beam.required())
        throw std::runtime_error(o_.primary_beam.asked() + ": no primary beam can be applied: " + none.what());
      if (o_.primary_beam.wanted()) warn(std::string("no .pb is written: ") + none.what());
      if (o_.measures_noise_in_beam()) warn(std::string("masks have the noise of all of the image: ") + none.what());
      o_.primary_beam = {};
    }
  }

  /// Opens masks and models, so that their errors are reported at once.
  void open_clean() {
    for (const std::string& model : o_.clean.startmodel)
      require_same_target(model, *open_image_file(model, imager::Grids::any), *set_, names_of(o_.vis));
    clean_ = std::make_unique<CleanStage>(o_, header_);
    for (const auto& mask : clean_->mask_files())
      if (mask->file() != nullptr) require_same_target("mask " + mask->path(), *mask->file(), *set_, names_of(o_.vis));
    if (!cube()) clean_->begin_channel(0);
    for (const std::string& words : clean_->words_on_files()) warn(words);
    if (cube()) return;
    for (const std::string& words : clean_->warnings()) warn(words);
  }

  imager::SpectralAxis whole_band(const imager::Observation& observation) const {
    imager::SpectralAxis axis = imager::whole_band(observation);
    axis.rest_frequency_hz = rest_frequency_hz(o_.cube);
    return axis;
  }

  imager::SpectralAxis list_channels() {
    if (!cube()) {
      check_taylor_band(o_.taylor, windows_);
      return whole_band(set_->observation());
    }
    sampling_ = cube_sampling(o_.cube, windows_, set_->observation().spectral_frame);
    if (const std::string words = windows_left_out(sampling_.axis, windows_); !words.empty()) warn(words);
    report_.cube = sampling_.axis;
    return sampling_.axis;
  }

  /// Finds how far samples reach. Channels of a cube may lie half a channel beyond the data's last.
  void find_reach() {
    reach_ = sharing_.reach(*set_);
    double beyond = 0;
    for (const ms_io::SpectralWindow& window : windows_)
      for (std::size_t c = 0; cube() && c < window.frequency_hz.size(); ++c)
        beyond = std::max(beyond, 0.5 * window.channel_width_hz[c] / window.frequency_hz[c]);
    for (double* reach : {&reach_.max_abs_u, &reach_.max_abs_v, &reach_.max_abs_w}) *reach *= 1 + beyond;
  }

  void plan() {
    const auto own = static_cast<double>(set_->samples());
    const double all = sharing_.all_samples(own);
    const double enlarged = o_.scale.enlarged(all);
    const RunScene scene{
        .options = o_,
        .set = *set_,
        .ranks = ranks_,
        .geometry = header_.geometry,
        .reach = reach_,
        .threads = threads_,
        .mask = o_.clean.runs() && sharing_.images_here() && o_.masks_clean(),
        .taken = o_.taken.any() ? taken_.get() : nullptr,
        .mosaic = mosaic_.request,
        .channels = channels(),
        .workers = std::min(threads_, sharing_.channels_here(channels())),
        .samples = enlarged * (cube() ? static_cast<double>(set_->rows()) * samples_of_a_row(sampling_, windows_) : all),
        .share = own / all,
        .enlarged = enlarged};
    plan_ = plan_run(scene, times_, progress_);
    if (cube()) plan_.decisions.push_back(axis_decision(sampling_));
    plan_.decisions.insert(plan_.decisions.end(), notes_.decisions.begin(), notes_.decisions.end());
    plan_.decisions.insert(plan_.decisions.end(), mosaic_.decisions.begin(), mosaic_.decisions.end());
    if (primary_beam_) plan_.decisions.push_back(primary_beam_->decision());
    for (const std::string& warning : plan_.warnings) warn(warning);
    if (primary_beam_)
      for (const std::string& doubt : primary_beam_->doubts()) warn(doubt);
    cube() ? plan_batches(scene) : plan_streaming(scene);
    foretell(scene, forecast_, work_, times_, plan_);
    report_.plan = plan_.decisions;
    report_.geometry = header_.geometry;
    report_.accuracy = o_.gridding.accuracy;
    report_.gridding = &plan_.gridding;
    report_.estimated_memory_bytes = plan_.memory.total();
  }

  /// Plans the memory of the one channel.
  void plan_streaming(const RunScene& scene) {
    workers_ = {1, threads_};
    work_ = work_of(scene, plan_);
    // Ranks exchange the same in every pass, so that all keep visibilities or none does.
    plan_.streaming.keep = !imager::any_of(ranks_, !plan_.streaming.keep);
    visibilities_ = std::make_unique<ChannelVisibilities>(*set_, plan_.streaming);
    queue_ = make_channel_queue(imager::alone(), {{0, 1}}, *this);
  }

  /// Plans the memory of a cube's channels.
  void plan_batches(const RunScene& scene) {
    const ChannelBatches batches = tools::plan_batches(scene, plan_);
    batches_ = batches_of(channels(), batches);
    imager::share_list(ranks_, batches_);  // where ranks have unlike room, or threads
    queue_ = make_channel_queue(ranks_, batches_, *this);
    workers_ = batches.workers;
    at_once_ = workers_.count;
    imager::sum_over(ranks_, at_once_);
    if (!ranks_.alone())
      plan_.decisions.push_back(
          channel_sharing_decision(ranks_.size(), channels(), batches.channels, channel_bytes(work_of(scene, plan_))));
    plan_.gridding = imager::with_threads(std::move(plan_.gridding), workers_.threads);
    plan_.memory = batches.memory;
    plan_.decisions.push_back(batches.decision);
    work_ = work_of(scene, plan_);
    work_.workers = at_once_;
    work_.kept = !batches.read_again;
    visibilities_ = std::make_unique<ChannelVisibilities>(*set_, sampling_, batches, threads_);
  }

  std::vector<StageSeconds> expected() const { return expected_seconds(plan_, forecast_, work_); }

  void begin_channels() {
    if (ranks_.first() && o_.clean.runs() && !o_.clean.restart && states_went_at_first()) remove_states(o_);
    scene_ = std::make_unique<ChannelScene>(ChannelScene{.options = o_,
                                                         .option_values = call_.state_option_values,
                                                         .header = header_,
                                                         .reach = reach_,
                                                         .threads = workers_.threads,
                                                         .images_here = sharing_.images_here(),
                                                         .pointings = imager::pointings_of(mosaic_.request),
                                                         .whole_band = !cube(),
                                                         .taken = o_.taken.any() ? taken_.get() : nullptr,
                                                         .given_up = queue_->given_up(),
                                                         .told = cube() ? nullptr : &told_});
    ChannelMeans means{.plan = plan_.gridding,
                       .transform = nullptr,
                       .workers = workers_,
                       .images_here = sharing_.images_here(),
                       .primary_beam = primary_beam_.get()};
    if (cube()) {
      report_.plan.insert(report_.plan.end(), plan_.gridding.decisions.begin(), plan_.gridding.decisions.end());
      const imager::StageTimer timer(times_, imager::stage::plan);
      means.transform = std::make_shared<imager::PlannedTransform>(plan_.gridding);
    }
    maker_ = std::make_unique<ChannelMaker>(*scene_, std::move(means), std::move(clean_));
    if (cube()) open_products();
  }

  void open_products() {
    const imager::StageTimer timer(times_, imager::stage::write_images);
    if (ranks_.first() && o_.outformat != "fits") ms_io::require_room(o_.imagename, bytes_of_images());
    const PrimaryBeamStage* const written = o_.primary_beam.wanted() ? primary_beam_.get() : nullptr;
    products_ = std::make_unique<Products>(
        o_, header_, written, workers_, [this](const ProductKind& kind, const imager::ImageHeader& header) {
          auto elsewhere = queue_->writer(kind.name);
          if (elsewhere) return elsewhere;
          return open_image_files(o_.imagename + "." + kind.name, header, pixel_format(o_.gridding.accuracy), o_.outformat);
        });
  }

  /// The bytes of all images on the disk: all are begun before the first is written.
  std::uintmax_t bytes_of_images() const {
    const std::size_t pixel =
        pixel_format(o_.gridding.accuracy) == imager::PixelFormat::float64 ? sizeof(double) : sizeof(float);
    const int planes = channels() * product_planes(ProductChoice::of(o_), static_cast<int>(stokes_.size()));
    return (o_.outformat == "both" ? 2 : 1) * pixel * header_.geometry.pixels() * static_cast<std::size_t>(planes);
  }

  /// Weighs by the density of all channels' samples together.
  void weigh_in_common() {
    const imager::WeightingOptions options = weighting_options(o_.weighting, imager::pointings_of(mosaic_.request));
    if (!options.needs_density()) return;
    imager::UvDensity density(header_.geometry, threads_, options.pointings);
    const auto add = [&](const imager::VisibilitySource& channel) {
      const imager::StageTimer timer(times_, imager::stage::weights);
      const auto stream = channel.open();
      while (const auto block = stream->next()) density.add(*block);
    };
    visibilities_->look_through(own_batches(ranks_, batches_), add, progress_, times_);
    if (!ranks_.alone()) density.add_up(ranks_);
    maker_->weigh_by(std::make_shared<imager::ImagingWeights>(density, options));
  }

  /// Makes channels until there are no more, or the user stops: channels of a cube that are done by then stay.
  void make_channels() {
    try {
      while (!queue_->stopped()) {
        const std::optional<imager::PlaneRange> batch = queue_->next();
        if (!batch) break;
        make(*batch);
      }
    } catch (const Interrupted&) {
      if (!cube()) throw;
      queue_->stop();
    }
    queue_->finish();
    if (ranks_.first() && queue_->stopped() && report_.channels.empty()) throw Interrupted();
  }

  /// Makes as many channels at a time as there are workers. Rethrows an exception of one once all at work have ended;
  /// Interrupted comes last.
  void make(const imager::PlaneRange& batch) {
    imager::StageTimes reading;
    visibilities_->begin(batch, progress_, reading);
    add_times(reading, 1);
    if (cube()) progress_.begin(visibilities_->work_on(batch), o_.clean.runs());
    const auto count = static_cast<std::size_t>(batch.count);
    std::atomic<std::uint64_t> done = 0;
    std::atomic<bool> interrupted = false;
    imager::parallel_for(count, workers_.count, [&](std::size_t i) {
      if (queue_->stopped() || interrupted) return;
      try {
        make_group({batch.first + static_cast<int>(i), 1});  // each channel is cleaned alone
        if (cube()) progress_.update(++done, count);
      } catch (const Interrupted&) {  // also of a channel that gave up: the exception of another comes before it
        interrupted = true;
      } catch (...) {
        queue_->give_up();
        throw;
      }
    });
    visibilities_->end();
    if (interrupted) throw Interrupted();
    if (cube()) progress_.end();
  }

  /// Channels that are cleaned together: all are imaged before, and written after.
  void make_group(const imager::PlaneRange& group) {
    std::vector<std::unique_ptr<ChannelRun>> runs;
    for (int channel = group.first; channel < group.first + group.count; ++channel) runs.push_back(image(channel));
    std::call_once(states_removed_, [this] { remove_states_before(); });
    for (const auto& run : runs) maker_->clean(*run);
    for (const auto& run : runs) finish(*run);
  }

  /// States of a run before stay until there is something to clean, as this run may be refused before. Ranks that share a
  /// cube's channels do not wait for each other: there they went before any of them began.
  void remove_states_before() {
    if (ranks_.first() && o_.clean.runs() && !o_.clean.restart && !states_went_at_first()) remove_states(o_);
  }
  bool states_went_at_first() const { return cube() && !ranks_.alone(); }

  /// Makes all of a channel that comes before CLEAN.
  std::unique_ptr<ChannelRun> image(int channel) {
    imager::StageTimes taking;
    std::unique_ptr<ChannelSamples> samples;
    {
      const imager::StageTimer timer(taking, imager::stage::planes);
      samples = visibilities_->take(channel);
    }
    std::unique_ptr<ChannelRun> run = maker_->image(channel, std::move(samples));
    if (cube()) run->times().add(imager::stage::planes, taking.of(imager::stage::planes));
    if (!cube()) tell_dirty(*run);
    maker_->prepare_clean(*run);
    if (!cube() && ranks_.first()) begin_pictures(*run);
    return run;
  }

  /// Does all that comes after CLEAN.
  void finish(ChannelRun& run) {
    if (o_.check_outside) look_outside(run);
    if (run.has_samples() && visibilities_->each_reads()) visibilities_->count(run.samples().counts());
    run.release_samples();
    if (!cube() && ranks_.first())
      if (const std::string warning = changed_files_warning(*set_); !warning.empty()) warn(warning);
    if (sharing_.images_here() && !run.made().empty()) write(run);
    if (o_.clean.savemodel != "none")
      run.made().cleaned = models_of(std::move(run.cleaned()), run.images().images.normalisation);
    queue_->done(std::move(run.made()));
  }

  /// The models that --savemodel needs from CLEAN's results: images to predict.
  static std::vector<imager::CleanResult> models_of(std::vector<imager::CleanResult>&& cleaned,
                                                    const imager::Normalisation& by) {
    for (imager::CleanResult& result : cleaned) {
      by.make_predicted(result.model);
      for (imager::Image& model : result.further_models) by.make_predicted(model);
      result.residual = result.mask = {};
      result.further_residuals.clear();
    }
    return std::move(cleaned);
  }

  /// Reports on the dirty image before CLEAN begins, which may take long.
  void tell_dirty(ChannelRun& run) {
    const imager::AccurateImages& made = run.images();
    plan_.gridding = made.plan;
    report_.plan.insert(report_.plan.end(), made.plan.decisions.begin(), made.plan.decisions.end());
    count_samples_of(run);
    for (const imager::Decision& decision : run.report().decisions) report_.plan.push_back(decision);
  }

  /// Pictures of images before CLEAN are drawn while it runs.
  void begin_pictures(ChannelRun& run) {
    pictures_ = std::make_unique<RunPictures>(o_, header_, times_);
    pictures_->draw_dirty(run);
  }

  /// Reports the samples read, those that the pixel size cannot represent, and the pixel size that could.
  void count_samples_of(ChannelRun& run) {
    const imager::SampleSums& sums = run.report().sums;
    report_.counts = run.samples().counts();
    report_.counts.outside_grid = sums.outside_grid;
    report_.counts.used = sums.used;
    report_.plan.push_back(left_out_decision(report_.counts));
    if (sums.outside_grid > 0) warn(outside_grid_warning(sums.outside_grid, reach_));
    for (const std::string& warning : notes_on_data(*set_, ranks_)) warn(warning);
  }

  void look_outside(ChannelRun& run) {
    const imager::StageTimer timer(times_, imager::stage::sources_outside);
    imager::StageTimes own;  // its gridding is not this image's
    progress_.begin("sources outside", true);
    const imager::AccurateImages& made = run.images();
    const double noise_jy = !ranks_.first()         ? 0
                            : run.cleaned().empty() ? imager::robust_noise(made.images.dirty.front(), threads_)
                                                    : run.cleaned().front().report.final_state().rms_jy;
    outside_ = check_outside(run.samples(), made.plan, *plan_.wider, made.images,
                             {noise_jy, !weighting_options(o_.weighting).none()}, {threads_, &own, run.context().progress});
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

  void write(ChannelRun& run) {
    if (!cube()) open_products();
    products_->write(run, pictures_.get());
  }

  void write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
             const std::optional<imager::Beam>& beam) override {
    products_->write(kind, at, image, beam);
  }

  void take(MadeChannel&& channel) override {
    for (const std::string& sentence : channel.warnings) warn(sentence);
    tally_.add(channel);
    add_times(channel.times, at_once_);
    work_.components += channel.components;
    work_.major_cycles += channel.major_cycles;
    if (cube() && o_.clean.runs() && !channel.empty()) progress_.say(channel_line(channel.report, channels()));
    report_.channels.push_back(std::move(channel.report));
    cleaned_ = std::move(channel.cleaned);
  }

  /// Adds the times of a part of the work, of which `at_once` are done at a time.
  void add_times(const imager::StageTimes& times, int at_once) {
    const std::lock_guard lock(times_mutex_);
    for (const auto& [stage, seconds] : times.stages()) times_.add(stage, seconds / at_once);
  }

  /// Counts each sample read once: samples that are left out for no reason are used.
  void count_samples() {
    imager::SampleCounts& counts = report_.counts = visibilities_->counts();
    report_.outside_channels = visibilities_->outside_channels();
    counts.add_up(ranks_);
    imager::sum_over(ranks_, report_.outside_channels);
    const std::uint64_t taken = counts.samples_read - counts.autocorrelations - counts.flagged - counts.nonfinite -
                                counts.zero_weight - report_.outside_channels;
    counts.outside_grid = tally_.outside_grid_of(taken);
    report_.channel_samples = tally_.samples();
    counts.used = taken - counts.outside_grid;
    for (const std::string& warning : notes_on_data(*set_, ranks_)) warn(warning);
  }

  void finish_products() {
    tally_.require_any(report_.counts);
    std::string removed;
    for (const std::string& path : products_->finish(report_.channels, error_cards(report_), times_))
      removed += (removed.empty() ? "" : ", ") + path;
    if (!removed.empty()) progress_.say("removed what an earlier run left: " + removed);
    if (cube()) tell_channels();
    for (const std::string& doubt : tally_.doubts(!cube())) warn(doubt);
    if (cube())
      for (const std::string& words : tally_.missing(channels())) warn(words);
  }

  /// Reports what several channels have in common.
  void tell_channels() {
    report_.plan.push_back(left_out_decision(report_.counts));
    if (const std::string warning = changed_files_warning(*set_); !warning.empty()) warn(warning);
    if (tally_.outside_grid() > 0) warn(outside_grid_warning(report_.counts.outside_grid, reach_));
  }

  void write_report() {
    report_.shown = brightest_channel(report_.channels);
    ChannelReport& shown = report_.channels[report_.shown];
    if (cube()) look_at_shown(shown);
    PageDrawings drawings;
    {
      const imager::StageTimer timer(times_, imager::stage::draw_pictures);
      (cube() ? drawings.spectrum : drawings.histogram) = cube() ? spectrum_drawing(report_) : histogram_drawing(shown);
    }
    std::vector<PagePicture> pictures;
    if (const std::string failure = pictures_->finish(pictures); !failure.empty()) warn(failure);
    report_.expected = expected();
    const auto made_twice = [](const ChannelReport& channel) { return channel.made_twice; };
    const bool as_planned = !o_.clean.runs() || !imager::may_be_coarser(plan_.gridding);
    if (!o_.taken.any() && as_planned && std::none_of(report_.channels.begin(), report_.channels.end(), made_twice))
      forecast_.learn(work_, times_);
    report_.wall_clock_s = watch_.seconds();
    outcome_.report = report_json(report_);
    write_file(o_.imagename + ".report.json", json_text(outcome_.report, 2) + "\n");
    write_file(o_.imagename + ".report.html", report_page(outcome_.report, pictures, drawings));
  }

  /// The channel of a cube that its report shows, from files.
  void look_at_shown(ChannelReport& shown) {
    {
      const imager::StageTimer timer(times_, imager::stage::statistics);
      const auto residual = open_written(o_, "residual");
      for (std::size_t s = 0; s < shown.stokes.size() && shown.sums.used > 0; ++s) {
        PixelHistogram& histogram = shown.stokes[s].histogram;
        histogram = pixel_histogram(residual->read({shown.channel, static_cast<int>(s)}), histogram.noise_jy, threads_);
      }
    }
    pictures_ = std::make_unique<RunPictures>(o_, header_, times_);
    pictures_->draw_channel(shown);
    for (const imager::Decision& d : shown.decisions)
      report_.plan.push_back({d.item + " of plane " + std::to_string(shown.channel), d.decision, d.because});
  }

  void warn_of_unselected() {
    for (std::size_t i = 0; i < o_.vis.size(); ++i)
      if (const std::string words = unselected_warning(o_.vis[i], set_->selection().of_set(i), {}); !words.empty()) warn(words);
  }

  std::string save_model() {
    visibilities_.reset();  // closed before a column is written
    set_.reset();
    progress_.begin("save model", true);  // a column half written helps no one
    sharing_.give_models(stokes_.size(), o_.taylor.nterms, cleaned_);
    const SavedModel model{header_.geometry,
                           threads_,
                           stokes_,
                           cleaned_,
                           json_text(report_.options),
                           [this](const std::string& sentence) { progress_.say(sentence); },
                           o_.taylor.nterms > 1 ? taylor_expansion(o_.taylor, header_.observation) : imager::TaylorExpansion()};
    std::string words = tools::save_model(o_, model, ranks_,
                                          [this](std::uint64_t done, std::uint64_t total) { progress_.update(done, total); });
    progress_.end();
    return words;
  }

  ImageOptions o_;  ///< less a primary beam that the antennas do not have
  const RunCall& call_;
  const imager::Ranks& ranks_;
  Sharing sharing_;
  std::unique_ptr<NameLock> name_;  ///< the first rank's
  std::vector<imager::Stokes> stokes_;
  int threads_;
  ProgressLine progress_;
  imager::Stopwatch watch_;
  imager::StageTimes times_;
  std::mutex times_mutex_;  ///< guards times_, while channels of other ranks come in
  ToldAsItGoes told_{progress_, times_, [this](const std::string& sentence) { warn(sentence); }};
  RunReport report_;
  Outcome outcome_;
  TimeForecast forecast_{default_cache_folder()};
  RunWork work_;

  std::unique_ptr<ms_io::MeasurementSet> set_;
  std::vector<ms_io::SpectralWindow> windows_;
  imager::CubeSampling sampling_;  ///< of a cube
  imager::ImageHeader header_;
  ms_io::SetReach reach_;
  FieldNotes notes_;
  std::unique_ptr<PrimaryBeamStage> primary_beam_;  ///< null where neither images nor masks need it
  MosaicStage mosaic_;                              ///< empty unless pointings become one image
  std::unique_ptr<TakenFiles> taken_;               ///< null where all images are made
  std::unique_ptr<CleanStage> clean_;               ///< until channels begin; null where nothing is cleaned here
  RunPlan plan_;
  std::vector<imager::PlaneRange> batches_;  ///< of a cube
  ChannelWorkers workers_;
  int at_once_ = 1;  ///< channels that all ranks make at a time
  std::unique_ptr<ChannelVisibilities> visibilities_;
  std::unique_ptr<ChannelScene> scene_;
  std::unique_ptr<ChannelMaker> maker_;
  std::once_flag states_removed_;          ///< of a run before
  std::unique_ptr<Products> products_;     ///< where there are images
  std::unique_ptr<RunPictures> pictures_;  ///< of rank 0
  OutsideReport outside_;
  std::vector<imager::CleanResult> cleaned_;  ///< [Stokes], of the one channel, where --savemodel needs them
  ChannelTally tally_;
  std::unique_ptr<ChannelQueue> queue_;  ///< last: its thread uses the members above
};

}  // namespace

Outcome run_image(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks) {
  return ImageRun(options, call, ranks).run();
}

}  // namespace misfit::tools
