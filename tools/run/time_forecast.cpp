#include "tools/run/time_forecast.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/json_text.h"
#include "tools/kernel_choice/machine_costs.h"

namespace misfit::tools {
namespace {

namespace stage = imager::stage;

namespace fs = std::filesystem;
using nlohmann::json;

/// Without a copy, which takes as much stack as a damaged file has brackets.
bool has(const json& object, const char* name, const json& value) {
  return object.is_object() && object.contains(name) && object[name] == value;
}

/// Turns seconds of one core into seconds of `threads`: two cores do 1.8 times as much as one, as measured.
double shared(double seconds, int threads) {
  return seconds / std::pow(static_cast<double>(threads), 0.85);
}

std::string way_of(const imager::GriddingWork& work) {
  const bool single = work.precision == imager::Precision::single_precision;
  return std::string(work.has_w_axis() ? " with w" : " in the plane") + (single ? ", single" : ", double");
}

/// Gridding and FFTs of some images of one plan.
struct TransformSeconds {
  double grid = 0;
  double fft = 0;
};

/// The images made in a pass.
struct Images {
  int stokes = 1;  ///< or Taylor terms; 0: a PSF alone
  bool psf = false;
};

TransformSeconds transform_seconds(const imager::GriddingPlan& plan, const Images& images, int threads, int ranks) {
  if (images.stokes == 0 && !images.psf) return {};
  if (plan.windows) {
    TransformSeconds sum;
    const Images of_window{plan.windows->images_each() * (images.stokes + (images.psf ? 1 : 0)), false};
    for (const auto& of_term : plan.windows->of_term) {
      const TransformSeconds one = transform_seconds(*of_term, of_window, threads, ranks);
      sum.grid += plan.windows->transforms() * one.grid;
      sum.fft += plan.windows->transforms() * one.fft;
    }
    return sum;
  }
  imager::GriddingWork work = plan.choice.best.work;
  work.samples /= ranks;
  work.gathers = (work.gathers + ranks - 1) / ranks;
  work.stokes = images.stokes;
  work.psf = images.psf;
  const imager::CostModel model;
  // Every cell is set to 0, and written once where samples are few: this part of what its FFT takes, as measured.
  constexpr double cells = 0.6;
  const double fft_s = model.fft_seconds(work);
  return {shared(model.gridding_seconds(work) + cells * fft_s, threads), shared(fft_s, threads)};
}

/// The size of a run, a part of the names of factors.
std::string size_of(const RunWork& w) {
  const auto power = [](double count) { return std::to_string(std::lround(std::log2(std::max(count, 1.0)))); };
  return ", 2^" + power(w.samples) + " samples, 2^" + power(w.pixels) + " pixels";
}

/// The difference of two sizes in names of factors, in powers of two; none where one of them is no size.
std::optional<int> between_sizes(const std::string& one, const std::string& other) {
  int samples[2], pixels[2];
  for (const int i : {0, 1})
    if (std::sscanf((i == 0 ? one : other).c_str(), ", 2^%3d samples, 2^%3d pixels", &samples[i], &pixels[i]) != 2) return {};
  return std::abs(samples[0] - samples[1]) + std::abs(pixels[0] - pixels[1]);
}

constexpr int most_runs = 8;  ///< that count

/// To be changed when counts change: factors of seconds over other counts say nothing.
constexpr int count_version = 4;

constexpr double direct_term_s = 0.5e-9;  ///< measured, in vectors; CostModel's, which decides on direct sums, is cautious

/// A pass that images: the first makes the PSF and all Stokes parameters, others all Taylor terms.
void add_pass(const RunWork& w, bool with_psf, double times, std::vector<StageSeconds>& stages) {
  const imager::GriddingPlan& plan = *w.plan;
  const bool makes_psf = with_psf && plan.request.psf;
  const int stokes = !with_psf ? w.terms : w.residual_taken ? 0 : plan.request.stokes;
  if (plan.direct) {
    const double sums = w.samples * w.pixels * (makes_psf ? 1 + stokes : stokes);
    stages.push_back({stage::grid, "direct sums of images", times * shared(direct_term_s * sums, w.threads)});
    return;
  }
  const TransformSeconds own = transform_seconds(plan, {stokes, makes_psf && !plan.psf}, w.threads, w.ranks);
  const TransformSeconds psf =
      makes_psf && plan.psf ? transform_seconds(*plan.psf, {0, true}, w.threads, w.ranks) : TransformSeconds();
  const std::string way = way_of(plan.choice.best.work);
  stages.push_back({stage::grid, "gridding" + way, times * (own.grid + psf.grid)});
  stages.push_back({stage::fft, "FFTs" + way, times * (own.fft + psf.fft)});
}

/// The pass for dirty images and PSFs of further Taylor terms.
void add_taylor_pass(const RunWork& w, std::vector<StageSeconds>& stages) {
  if (w.terms == 1) return;
  const imager::GriddingPlan& plan = *w.plan;
  const int dirty = w.terms - 1, psfs = 2 * w.terms - 2;
  if (plan.direct) {
    stages.push_back({stage::grid, "direct sums of images",
                      shared(direct_term_s * w.samples * w.pixels * static_cast<double>(dirty + psfs), w.threads)});
    return;
  }
  const TransformSeconds own = transform_seconds(plan, {dirty}, w.threads, w.ranks);
  const TransformSeconds psf = transform_seconds(plan.psf ? *plan.psf : plan, {psfs}, w.threads, w.ranks);
  const std::string way = way_of(plan.choice.best.work);
  stages.push_back({stage::grid, "gridding" + way, own.grid + psf.grid});
  stages.push_back({stage::fft, "FFTs" + way, own.fft + psf.fft});
}

void add_predictions(const RunWork& w, std::vector<StageSeconds>& stages) {
  const imager::GriddingPlan& plan = *w.plan;
  const double model_pixels = std::min(w.components, w.pixels) / 2;  // on average over the cycles
  if (plan.direct || model_pixels <= static_cast<double>(plan.direct_pixels)) {
    stages.push_back({stage::degrid, "direct sums of visibilities",
                      w.terms * w.major_cycles * shared(direct_term_s * w.samples * model_pixels, w.threads)});
    return;
  }
  const TransformSeconds one = transform_seconds(plan, {}, w.threads, w.ranks);
  const std::string way = way_of(plan.choice.best.work);
  stages.push_back({stage::degrid, "degridding" + way, w.terms * w.major_cycles * one.grid});
  stages.push_back({stage::fft, "FFTs" + way, w.terms * w.major_cycles * one.fft});
}

double minor_seconds(const RunWork& w) {
  const bool multiscale = w.deconvolver == "multiscale";
  const double component_s = multiscale ? 3e-5 : 1e-5, pixel_s = multiscale ? 8e-8 : 3e-8;
  return w.terms * (component_s * w.components + pixel_s * w.pixels * w.major_cycles);
}

/// The density of samples, the factors of its cells, and the samples' weights from them.
double weight_seconds(const RunWork& w) {
  constexpr double sample_s = 1.5e-8, taper_s = 1e-8, cell_s = 3e-9;
  return shared((sample_s + (w.tapered ? taper_s : 0)) * w.samples, w.threads) + cell_s * w.pixels / 2;
}

/// A search of a wider field: images, some major cycles of CLEAN, and a last prediction.
double wider_seconds(const RunWork& w) {
  RunWork wider = w;
  wider.plan = w.wider;
  wider.pixels = static_cast<double>(w.wider->request.geometry.pixels());
  wider.deconvolver = "hogbom";
  wider.components = 500;
  wider.major_cycles = 5;
  wider.terms = 1;
  constexpr double taper_s = 2e-8;  // of a sample's weight, and of the copy of its block
  std::vector<StageSeconds> stages;
  add_pass(wider, true, 1, stages);
  add_predictions(wider, stages);
  add_pass(wider, false, wider.major_cycles - 1, stages);
  return total_seconds(stages) + minor_seconds(wider) + taper_s * w.samples * (2 * wider.major_cycles);
}

/// The seconds of a cube: an image for each channel, of a part of the samples each, drawn once.
std::vector<StageSeconds> cube_seconds(const RunWork& w) {
  RunWork channel = w;
  channel.channels = 1;
  channel.workers = 1;
  channel.ranks = 1;
  channel.threads = std::max(1, w.ranks * w.threads / w.workers);
  channel.samples = w.samples / w.channels;
  std::vector<StageSeconds> stages = counted_seconds(channel);
  for (StageSeconds& s : stages)
    if (s.stage != stage::draw_pictures) s.seconds *= 1.0 * w.channels / (s.stage == stage::read ? w.ranks : w.workers);
  stages.push_back({stage::planes, "dealing out to planes", shared(1e-8 * w.samples / w.ranks, w.threads)});
  return stages;
}

}  // namespace

std::vector<StageSeconds> counted_seconds(const RunWork& w) {
  if (w.channels > 1) return cube_seconds(w);
  const double passes = w.kept ? 1 : 1 + (w.density ? 1 : 0) + w.major_cycles;
  std::vector<StageSeconds> stages{{stage::read, "reading", passes * (4e-9 * w.samples + 1e-7 * w.rows)}};
  if (w.density) stages.push_back({stage::weights, "weighting by density", weight_seconds(w)});
  add_pass(w, true, 1, stages);
  add_taylor_pass(w, stages);
  stages.push_back({stage::statistics, "statistics", 8e-9 * w.pixels * (1 + w.major_cycles)});
  if (w.verified > 0) stages.push_back({stage::verify, "verifying", shared(direct_term_s * w.samples * w.verified, w.threads)});
  stages.push_back({stage::fit_beam, "fitting the beam", 5e-3});
  if (w.major_cycles > 0) {
    const std::string several = w.terms > 1 ? " with Taylor terms" : "";
    stages.push_back({stage::minor_cycles, "minor cycles of " + w.deconvolver + several, minor_seconds(w)});
    add_predictions(w, stages);
    add_pass(w, false, w.major_cycles, stages);
    stages.push_back({stage::clean_state, "writing CLEAN's state", 1e-8 * w.pixels + 5e-3 * w.major_cycles});
    stages.push_back({stage::restore, "restoring", 1e-8 * w.pixels * w.terms});
  }
  if (w.wider != nullptr) stages.push_back({stage::sources_outside, "search outside", wider_seconds(w)});
  if (w.primary_beam)
    stages.push_back({stage::primary_beam, "primary beams", shared(2e-9 * w.samples + 3e-8 * w.pixels, w.threads)});
  stages.push_back({stage::write_images, "writing images", 1e-8 * w.pixels * w.images});
  stages.push_back({stage::draw_pictures, "drawing pictures", 0.07 * w.pictures + 1e-9 * w.pixels * w.pictures});
  return stages;
}

RunWork with_cycles(RunWork work, int cycles, int components) {
  work.major_cycles = cycles;
  work.components = 1.0 * cycles * components;
  return work;
}

double total_seconds(const std::vector<StageSeconds>& stages) {
  double sum = 0;
  for (const StageSeconds& s : stages) sum += s.seconds;
  return sum;
}

TimeForecast::TimeForecast(const fs::path& folder) {
  if (folder.empty()) return;
  file_ = folder / "times.json";
  std::error_code none;
  if (!fs::is_regular_file(file_, none)) return;
  const json kept = json::parse(read_file(file_), nullptr, false);
  if (!has(kept, "machine", machine_name()) || !has(kept, "counts", count_version) || !kept.contains("kinds")) return;
  for (const auto& [kind, value] : kept["kinds"].items()) {
    if (!value.is_object() || !value.contains("log") || !value.contains("runs")) continue;
    const json &log = value["log"], &runs = value["runs"];
    constexpr double most_log = 30;  // no machine is so much slower
    if (log.is_number() && std::abs(log.get<double>()) < most_log && runs.is_number_integer() && runs >= 1 && runs <= most_runs)
      factor_[kind] = {log, runs};
  }
}

double TimeForecast::log_factor(const std::string& kind, const std::string& size) const {
  double log = 0;
  std::optional<int> nearest;
  for (auto factor = factor_.lower_bound(kind); factor != factor_.end() && factor->first.rfind(kind, 0) == 0; ++factor) {
    const std::optional<int> distance = between_sizes(factor->first.substr(kind.size()), size);
    if (!distance || (nearest && *nearest <= *distance)) continue;
    nearest = distance;
    log = factor->second.log;
  }
  return log;
}

std::vector<StageSeconds> TimeForecast::expected(const RunWork& work, const RunWork& as_large) const {
  std::vector<StageSeconds> sums;
  const std::string size = size_of(as_large);
  for (StageSeconds counted : counted_seconds(work)) {
    counted.seconds *= std::exp(log_factor(counted.kind, size));
    const auto same = std::find_if(sums.begin(), sums.end(), [&](const StageSeconds& s) { return s.stage == counted.stage; });
    if (same == sums.end()) {
      sums.push_back(counted);
    } else {
      same->seconds += counted.seconds;
    }
  }
  return sums;
}

bool TimeForecast::knows(const RunWork& work) const {
  const auto stages = counted_seconds(work);
  return std::all_of(stages.begin(), stages.end(), [&](const StageSeconds& s) { return factor_.count(s.kind) > 0; });
}

void TimeForecast::learn(const RunWork& work, const imager::StageTimes& took) {
  constexpr double least_s = 5e-3;
  std::map<std::string, double> off;  // log of seconds taken over seconds expected, by stage
  for (const StageSeconds& e : expected(work))
    for (const auto& [stage, seconds] : took.stages())
      if (stage == e.stage && seconds >= least_s && e.seconds > 0) off[stage] = std::log(seconds / e.seconds);
  std::map<std::string, double> should;  // log factors, by kind
  for (const StageSeconds& counted : counted_seconds(work))
    if (off.count(counted.stage) > 0) should[counted.kind] = log_factor(counted.kind, size_of(work)) + off.at(counted.stage);
  for (const auto& [kind, log] : should)
    for (const std::string& name : {kind, kind + size_of(work)}) {
      Factor& factor = factor_[name];
      factor.runs = std::min(factor.runs + 1, most_runs);
      factor.log += (log - factor.log) / factor.runs;
    }
  if (file_.empty()) return;
  json kept{{"machine", machine_name()}, {"counts", count_version}, {"kinds", json::object()}};
  for (const auto& [kind, factor] : factor_) kept["kinds"][kind] = {{"log", factor.log}, {"runs", factor.runs}};
  std::error_code none;
  fs::create_directories(file_.parent_path(), none);
  try {
    write_file(file_.string(), json_text(kept, 2) + "\n");
  } catch (const std::runtime_error&) {  // a folder that cannot be written is no cache, and no error
  }
}

}  // namespace misfit::tools
