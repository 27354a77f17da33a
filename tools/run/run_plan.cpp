#include "tools/run/run_plan.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>

#include "imager/clean/scales.h"
#include "imager/outside/wide_search.h"
#include "imager/plan/planned_transform.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/run/data_columns.h"
#include "tools/run/data_summary.h"
#include "tools/run/gridding_options.h"
#include "tools/run/memory_plan.h"
#include "tools/run/outside_stage.h"
#include "tools/run/pixel_plan.h"
#include "tools/run/primary_beam_stage.h"
#include "tools/run/product_kinds.h"
#include "tools/run/scale_forecast.h"
#include "tools/run/sharing.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {
namespace {

/// The planes that a run writes of one channel, except masks.
int written_images(const ImageOptions& o, int stokes) {
  ProductChoice choice = ProductChoice::of(o);
  choice.masked = false;
  return product_planes(choice, stokes);
}

/// The planes among them for the primary beam.
int beam_images(const ImageOptions& o, int stokes) {
  ProductChoice choice = ProductChoice::of(o), without = choice;
  without.primary_beam = without.corrected = false;
  return product_planes(choice, stokes) - product_planes(without, stokes);
}

/// The decisions of a run, in the order in which they are made.
class RunPlanner {
 public:
  RunPlanner(const RunScene& scene, ProgressLine& progress) : scene_(scene), o_(scene.options), progress_(progress) {}

  void decide_all() {
    imager::GriddingRequest request = gridding_request(o_.gridding, scene_.threads);
    request.geometry = scene_.geometry;
    request.samples = static_cast<std::uint64_t>(scene_.samples);
    request.stokes = static_cast<int>(imager::parse_stokes(o_.stokes).size());
    request.psf = o_.taken.calcpsf;
    request.mosaic = scene_.mosaic;
    request.max_abs_w = scene_.reach.max_abs_w;
    const imager::GriddingRequest unlimited = request;
    if (o_.memory_gib > 0) limit_memory(o_.memory_gib * gib, request);
    plan_.gridding = plan_gridding(request);
    plan_.decisions = data_decisions(scene_.set, scene_.reach);
    decide_pixels();
    if (!scene_.set.ranks().alone()) decide_sharing();
    if (o_.taylor.nterms > 1) decide_terms();
    if (scene_.taken != nullptr)
      for (imager::Decision& taken : scene_.taken->decisions()) plan_.decisions.push_back(std::move(taken));
    plan_.decisions.push_back(weighting_decision(o_.weighting, scene_.geometry, imager::pointings_of(scene_.mosaic)));
    if (o_.check_outside) plan_search(request);
    decide_memory([&](double bytes) { return least_memory(unlimited, bytes); });
    decide_columns();
    decide("columns and correlations", "only what Stokes " + o_.stokes + " needs",
           "UVW, antennas, flags, weights and one data column, each read once");
    if (o_.clean.runs()) {
      decide_psf_patch();
      decide_residuals();
    }
    warn_of_neglected_w();
  }

  RunPlan take() { return std::move(plan_); }

 private:
  void decide(const std::string& item, const std::string& decision, const std::string& because) {
    plan_.decisions.push_back({item, decision, because});
  }

  std::vector<imager::LookedAt> scales_looked_at() const {
    return imager::scales_looked_at({deconvolver_choice(o_.clean, 1).scale_pixels});
  }

  /// Decides how much of the PSF minor cycles subtract.
  void decide_psf_patch() {
    decide("PSF patch", "none, the whole PSF",
           "components are taken off bright pixels alone, of which there are few; at the threshold, off all");
  }

  /// Decides how exactly major cycles subtract.
  void decide_residuals() {
    if (!imager::may_be_coarser(plan_.gridding)) return;
    decide("residuals", "the last to " + significant(o_.gridding.accuracy, 3) + ", those before as exactly as is needed",
           "their errors are at most a fiftieth of the depth to which components are then found; the report has each accuracy");
  }

  /// Plans the gridding. A search outside shares the memory. Ranks with different plans would not exchange alike: all gather as
  /// many samples as the rank with the least room.
  imager::GriddingPlan plan_gridding(imager::GriddingRequest request) const {
    if (o_.check_outside) return imager::plan_gridding(request);
    imager::GriddingPlan plan = plan_with_room(
        request, [this](const imager::GriddingPlan& made) { return demand_of(made, {}); }, o_,
        memory_of_a_process(scene_.ranks));
    const auto own = static_cast<double>(plan.request.samples_at_once);
    const double least = -imager::largest_of(scene_.ranks, -own);
    if (least == own) return plan;
    request.samples_at_once = static_cast<std::size_t>(least);
    return imager::plan_gridding(request);
  }

  void decide_pixels() {
    plan_.decisions.push_back(pixels_decision(o_, scene_.geometry, scene_.reach.longest_lambda));
    plan_.decisions.push_back(field_decision(o_, scene_.geometry, scene_.set));
    if (!has_unit(o_.cell)) progress_.say(cell_words(o_));
  }

  void decide_columns() {
    const std::vector<ms_io::DataColumn> columns = scene_.set.data_columns();
    plan_.decisions.push_back(data_column_decision(columns, o_.datacolumn));
    if (std::string warning = unlike_columns_warning(columns, o_.datacolumn); !warning.empty())
      plan_.warnings.push_back(std::move(warning));
  }

  void decide_sharing() {
    const int stokes = plan_.gridding.request.stokes;
    const ExchangeForecast exchange =
        exchange_of(static_cast<double>(scene_.geometry.pixels()), 3 * o_.taylor.nterms - 2 + stokes, o_.taylor.nterms);
    plan_.decisions.push_back(sharing_decision(scene_.set.sharing(), exchange));
  }

  void decide_terms() {
    const double reference_hz = taylor_expansion(o_.taylor, scene_.set.observation()).reference_hz;
    decide("Taylor terms", std::to_string(o_.taylor.nterms) + " about " + significant(reference_hz / 1e9, 9) + " GHz",
           (o_.taylor.reffreq.empty() ? "the middle of the band" : "--reffreq " + o_.taylor.reffreq) + "; " +
               std::to_string(2 * o_.taylor.nterms - 1) + " spectral PSFs. --accuracy holds for .tt0");
    if (!o_.clean.runs()) return;
    if (o_.makes_mosaic()) return decide("spectral index .alpha", "that of the sky", "a mosaic has the beam of each frequency");
    const std::string seen =
        "as the antennas saw it: their beam narrows with frequency, which adds −1.5 at the half power of an Airy disc";
    const std::string sky =
        o_.primary_beam.pbcor ? ".alpha.pbcor is that of the sky" : "--pbcor writes that of the sky, .alpha.pbcor";
    decide("spectral index .alpha", seen, sky);
    progress_.say(".alpha is the spectral index " + seen + "; " + sky);
  }

  /// Plans the search for sources outside, before a visibility is read.
  void plan_search(const imager::GriddingRequest& request) {
    imager::WideFieldFinder finder(scene_.geometry);
    scene_.set.visit_coordinates([&](const imager::SampleCoordinates& some) { finder.add(some); });
    finder.add_up(scene_.set.ranks());
    plan_.wide_field = finder.field();
    plan_.wider = std::make_unique<imager::GriddingPlan>(imager::plan_wide_field(plan_.wide_field, request));
  }

  static imager::WiderDemand wider_demand(const imager::GriddingPlan& wider, const imager::WideField& field) {
    return {imager::memory_of(wider), static_cast<double>(field.geometry.pixels())};
  }

  imager::MemoryDemand demand_of(const imager::GriddingPlan& gridding, std::optional<imager::WiderDemand> wider) const {
    return {.transform = imager::memory_of(gridding),
            .pixels = static_cast<double>(scene_.geometry.pixels()),
            .rows = static_cast<double>(scene_.set.rows()) * scene_.enlarged,
            .samples = scene_.samples * scene_.share,
            .block_samples = static_cast<double>(ms_io::MeasurementSet::usual_block_samples),
            .read_at_once = static_cast<double>(scene_.set.read_at_once()),
            .stokes = gridding.request.stokes,
            .verify = o_.verify > 0,
            .terms = o_.taylor.nterms,
            .clean_scales = o_.clean.runs() ? static_cast<int>(scales_looked_at().size()) : 0,
            .mask = scene_.mask,
            .start_model = !o_.clean.startmodel.empty(),
            .density = weighting_options(o_.weighting).needs_density(),
            .pointings = weighting_options(o_.weighting, imager::pointings_of(scene_.mosaic)).pointings,
            .beam_images = beam_images(o_, gridding.request.stokes),
            .wider = wider};
  }

  /// The least bytes that the run takes when it is planned for `bytes`.
  double least_memory(imager::GriddingRequest request, double bytes) const {
    limit_memory(bytes, request);
    std::optional<imager::WiderDemand> wider;
    if (plan_.wider) wider = wider_demand(imager::plan_wide_field(plan_.wide_field, request), plan_.wide_field);
    return imager::peak_memory(demand_of(imager::plan_gridding(request), wider), least_streaming).total();
  }

  void decide_memory(const std::function<double(double)>& least_with) {
    std::optional<imager::WiderDemand> wider;
    if (plan_.wider) wider = wider_demand(*plan_.wider, plan_.wide_field);
    const MemoryPlan memory = plan_memory(demand_of(plan_.gridding, wider), o_, memory_of_a_process(scene_.ranks), least_with);
    plan_.streaming = memory.streaming;
    constexpr double least_lambda = 1;  // where samples of u = v = 0 alone have cells, too
    plan_.streaming.uv_reach_lambda = std::max(
        least_lambda, std::min(std::max(scene_.reach.max_abs_u, scene_.reach.max_abs_v), 0.5 / scene_.geometry.cell_rad));
    plan_.memory = memory.peak;
    if (scene_.channels == 1) plan_.decisions.push_back(memory.decision);
  }

  void warn_of_neglected_w() {
    const double phase_rad = imager::max_w_phase_rad(scene_.reach.max_abs_w, scene_.geometry);
    const bool harms = phase_rad > (o_.gridding.accuracy == 0 ? plan_.gridding.worst_error : o_.gridding.accuracy);
    if (plan_.gridding.leaves_w_out() && harms)
      plan_.warnings.push_back("w is neglected although its phase reaches " + significant(phase_rad, 2) +
                               " rad at the image's corner: the image's error there is of that size; --gridder wide "
                               "takes w exactly");
  }

  const RunScene& scene_;
  const ImageOptions& o_;
  ProgressLine& progress_;
  RunPlan plan_;
};

double search_seconds(const std::vector<StageSeconds>& stages) {
  for (const StageSeconds& s : stages)
    if (s.stage == imager::stage::sources_outside) return s.seconds;
  return 0;
}

}  // namespace

RunPlan plan_run(const RunScene& scene, imager::StageTimes& times, ProgressLine& progress) {
  check(scene.options.scale, scene.ranks);
  RunPlanner planner(scene, progress);
  {
    const imager::StageTimer timer(times, imager::stage::plan);
    planner.decide_all();
  }
  return planner.take();
}

void foretell(const RunScene& scene, const TimeForecast& forecast, const RunWork& work, const imager::StageTimes& times,
              RunPlan& plan) {
  for (const auto& [stage, seconds] : times.stages()) plan.spent.push_back({stage, "", seconds});
  if (plan.wider) plan.decisions.push_back(search_decision(plan.wide_field, search_seconds(forecast.expected(work))));
  const bool cleans = scene.options.clean.runs();
  plan.decisions.push_back(
      {"expected time", duration(total_seconds(expected_seconds(plan, forecast, work))) + (cleans ? " without CLEAN" : ""),
       forecast.knows(work) ? "from counts of operations, and what earlier runs took on this machine"
                            : "from counts of operations; not all of them were timed on this machine before"});
  if (cleans) {
    const int components = components_of_a_cycle(scene.options);
    const auto seconds = [&](int cycles) { return total_seconds(forecast.expected(with_cycles(work, cycles, components))); };
    plan.decisions.push_back(
        {"expected time of a major cycle", duration(seconds(2) - seconds(1)), "with " + grouped(components) + " components"});
  }
  if (scene.options.scale.nodes > 0) plan.scale = ScaleForecast(scene, plan, forecast, work).table();
}

int components_of_a_cycle(const ImageOptions& options) {
  return std::min(options.clean.niter, 1000);
}

RunWork work_of(const RunScene& scene, const RunPlan& plan) {
  const ImageOptions& o = scene.options;
  const int stokes = plan.gridding.request.stokes;
  return {.plan = &plan.gridding,
          .rows = static_cast<double>(scene.set.rows()) * scene.enlarged,
          .samples = static_cast<double>(scene.set.samples()) * scene.enlarged,
          .channels = scene.channels,
          .workers = scene.channels > 1 ? scene.workers * scene.ranks.size() : 1,
          .ranks = (scene.channels > 1 ? scene.ranks : scene.set.ranks()).size(),
          .kept = plan.streaming.keep,
          .pixels = static_cast<double>(scene.geometry.pixels()),
          .images = written_images(o, stokes),
          .pictures = 2 + stokes * (o.clean.runs() ? 4 : 1) + (o.taylor.nterms > 1 && o.clean.runs() ? 1 : 0),
          .threads = scene.threads,
          .verified = static_cast<double>(o.verify),
          .residual_taken = !o.taken.calcres,
          .deconvolver = o.clean.deconvolver,
          .terms = o.taylor.nterms,
          .density = weighting_options(o.weighting).needs_density(),
          .tapered = weighting_options(o.weighting).tapers(),
          .primary_beam = o.primary_beam.wanted() || o.measures_noise_in_beam(),
          .wider = plan.wider.get()};
}

std::vector<StageSeconds> expected_seconds(const RunPlan& plan, const TimeForecast& forecast, const RunWork& work) {
  std::vector<StageSeconds> stages = plan.spent;
  for (const StageSeconds& s : forecast.expected(work)) stages.push_back(s);
  return stages;
}

std::string plan_text(const RunPlan& plan, const std::vector<StageSeconds>& expected) {
  std::string text;
  for (const imager::Plan* decisions : {&plan.decisions, &plan.gridding.decisions})
    for (const imager::Decision& d : *decisions) text += legible(d.item + ": " + d.decision + "; " + d.because) + "\n";
  const auto line = [](std::string stage, double seconds) {
    stage.resize(std::max<std::size_t>(stage.size(), 16), ' ');
    return "expected: " + stage + " " + duration(seconds) + "\n";
  };
  for (const StageSeconds& s : expected) text += line(s.stage, s.seconds);
  return text + line("total", total_seconds(expected)) + memory_table(plan.memory) + plan.scale;
}

}  // namespace misfit::tools
