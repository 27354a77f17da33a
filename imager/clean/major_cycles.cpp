#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/clean/clean.h"
#include "imager/clean/cycle_rules.h"
#include "imager/clean/finite_images.h"
#include "imager/clean/mask.h"
#include "imager/clean/shared_model.h"
#include "imager/data/noise.h"
#include "imager/taylor/taylor_imaging.h"

namespace misfit::imager {
namespace {

constexpr double grown = 1.5;  // a residual this many times the best is taken back
constexpr double exact = 0;    // accuracy of transforms that are as exact as any

/// `input`, which fits the minor cycle and the state that CLEAN begins with.
CleanInput checked(CleanInput input, const MinorCycle& minor, const CleanState& state) {
  const auto terms = static_cast<std::size_t>(input.expansion.terms);
  if (static_cast<std::size_t>(minor.terms()) != terms || input.dirty.size() != terms || input.psf.size() != 2 * terms - 1)
    throw std::invalid_argument(std::to_string(terms) + " Taylor terms, dirty images of " + std::to_string(input.dirty.size()) +
                                ", " + std::to_string(input.psf.size()) + " PSFs and a minor cycle of " +
                                std::to_string(minor.terms()) +
                                " terms; expected as many of each, and a PSF for each sum of two");
  if (state.model.scale_pixels() != minor.scale_pixels())
    throw std::invalid_argument("a model of other scales than those of the minor cycle");
  for (const Image* psf : input.psf) require_finite_psf(*psf);
  return input;
}

/// One run of CLEAN.
class Run {
 public:
  Run(CleanInput input, const MinorCycle& minor, const CleanOptions& options, CleanState state, const Context& context)
      : input_(checked(std::move(input), minor, state)),
        minor_(minor),
        o_(options),
        context_(context),
        sharer_(input_.imaged.samples.source.ranks()),
        state_(std::move(state)),
        rules_(input_, options, state_) {}

  CleanResult run(const CycleProgress& cycle_progress) {
    if (state_.cycles.empty())
      begin();
    else
      make_residual(now().accuracy);
    cycle_progress(state_);
    while (true) {
      while (!(end_ = rules_.ending(mask_is_empty()))) {
        one_cycle();
        cycle_progress(state_);
      }
      if (rules_.is_worse_than_best()) {
        return_to_best();
        make_exact();
        end_->reason += "; the best model was kept";
        break;
      }
      if (now().accuracy == exact) break;
      make_exact();
      stay_exact();
      if ((end_ = rules_.ending(mask_is_empty()))) break;
    }
    sharer_.end();
    return result();
  }

 private:
  const MajorCycle& now() const { return state_.cycles[state_.now]; }
  const MajorCycle& best() const { return state_.cycles[state_.best]; }
  const Image* mask() const { return o_.automask ? &state_.mask.allowed : o_.mask; }

  void begin() {
    MajorCycle start;
    start.iterations = state_.iterations;
    start.accuracy = make_residual(input_.dirty_accuracy);
    if (o_.automask) state_.mask.allowed = Image(residual().width, residual().height);
    measure(start);
    if (start.accuracy > rules_.accuracy_for_next(start.peak_residual_jy, start.rms_jy, start)) {
      start.accuracy = make_residual(exact);
      measure(start);
    }
    keep(std::move(start));
  }

  /// From here on no coarser transforms are taken, and their residuals do not count against CLEAN.
  void stay_exact() {
    if (state_.exact_from == 0) state_.exact_from = state_.cycles.size();
    state_.tightened = 0;
  }

  /// Makes the residual, and its measurements, as exact as any.
  void make_exact() {
    MajorCycle& cycle = state_.cycles[state_.now];
    if (cycle.accuracy == exact) return;
    make_residual(exact);
    cycle.accuracy = exact;
    measure(cycle);
  }

  int coarser_of(double accuracy) const {
    const auto& coarser = input_.coarser;
    const auto enough = [accuracy](const CoarserTransform& c) { return c.accuracy <= accuracy; };
    const auto found = std::find_if(coarser.begin(), coarser.end(), enough);
    return found == coarser.end() ? -1 : static_cast<int>(found - coarser.begin());
  }

  /// True while no residual was made, and the dirty images are the residuals of the model.
  bool begins_with_dirty() const {
    return residuals_.empty() && (input_.of_start || (state_.model.components().empty() && state_.cycles.size() <= 1));
  }

  /// Makes the residual, and returns its accuracy.
  double make_residual(double accuracy) {
    const bool dirty = begins_with_dirty() && accuracy >= input_.dirty_accuracy;
    residuals_.clear();
    if (dirty) {
      residuals_ = std::move(input_.dirty);
      accuracy = input_.dirty_accuracy;
    } else {
      input_.dirty.clear();
      const int coarser = coarser_of(accuracy);
      accuracy = coarser < 0 ? exact : input_.coarser[static_cast<std::size_t>(coarser)].accuracy;
      sharer_.share(state_.model, coarser);
      residuals_ =
          make_taylor_residuals(by_coarser(input_.imaged, input_.coarser, coarser), model_images(), input_.expansion, context_);
    }
    const StageTimer timer(context_.times, stage::statistics);
    for (std::size_t t = residuals_.size(); t-- > 0;) {
      statistics_ = statistics_of(residuals_[t], o_.threads);
      require_finite_residual(statistics_, rules_.dirty());
    }
    return accuracy;
  }
  std::vector<Image> model_images() const {
    const StageTimer timer(context_.times, stage::minor_cycles);
    std::vector<Image> images;
    for (int term = 0; term < input_.expansion.terms; ++term) images.push_back(state_.model.image(o_.threads, term));
    return images;
  }
  /// The residual of the first term, to whose units and noise thresholds refer.
  const Image& residual() const { return residuals_.front(); }

  bool mask_is_empty() const { return mask() != nullptr && imager::mask_is_empty(*mask()); }
  /// The peak within the mask; of the whole image where the mask is empty.
  double peak_within_mask() const {
    const bool everywhere = mask() == nullptr || mask_is_empty();
    return everywhere ? statistics_.largest_magnitude() : largest_magnitude_within(*mask(), residual(), o_.threads);
  }

  /// Measures the present residual.
  void measure(MajorCycle& cycle) {
    const StageTimer timer(context_.times, stage::statistics);
    cycle.rms_jy = robust_noise(residual(), o_.threads);
    cycle.peak_residual_jy = peak_within_mask();
    cycle.peak_anywhere_jy = statistics_.largest_magnitude();
    cycle.mean_square_jy2 = std::pow(statistics_.root_mean_square(), 2);
    cycle.model_flux_jy = state_.model.flux_jy();
  }

  /// Goes on from a cycle that was measured, within a mask that its residual has grown.
  void keep(MajorCycle cycle) {
    if (o_.automask) {
      if (!state_.mask.final) extend(cycle);
      cycle.peak_residual_jy = peak_within_mask();
    }
    cycle.mask_pixels = mask() != nullptr ? allowed_pixels(*mask()) : residual().pixel.size();
    state_.cycles.push_back(std::move(cycle));
    state_.now = state_.cycles.size() - 1;
  }

  void extend(MajorCycle& cycle) {
    const AutoMaskOptions& o = *o_.automask;
    const std::size_t before = allowed_pixels(state_.mask.allowed);
    cycle.masked = extend_mask(
        residual(), o,
        {.max_sidelobe = input_.max_sidelobe,
         .noise_jy = o.fast_noise ? cycle.rms_jy : mask_noise(residual(), state_.mask.allowed, o_.noise_within, o_.threads),
         .beam = input_.beam,
         .cell_rad = input_.cell_rad,
         .within = o_.mask,
         .threads = o_.threads},
        state_.mask);
    const bool at_the_end =
        cycle.cycle_threshold_jy > 0 && cycle.cycle_threshold_jy <= rules_.last_depth(state_.cycles[cycle.from]);
    const double changed =
        100 * static_cast<double>(cycle.masked.added) / static_cast<double>(std::max<std::size_t>(before, 1));
    state_.mask.final = at_the_end && !cycle.masked.by_sidelobes && changed < o.min_percent_change;
  }

  void one_cycle() {
    constexpr double hardly_less = 0.9;
    MajorCycle cycle;
    bool reached_depth = false;
    double noise_jy = 0;
    {
      const StageTimer timer(context_.times, stage::minor_cycles);
      MinorCycleOptions options = rules_.next();
      options.mask = mask();
      const MinorCycleReport found = minor_.clean(pointers_to(residuals_), options);
      state_.found_nothing = found.components.empty();
      cycle.iterations = now().iterations + found.iterations();
      cycle.cycle_threshold_jy = found.depth_jy;
      cycle.ended = description(found.end);
      noise_jy = found.noise_jy;
      reached_depth = found.end == MinorCycleEnd::threshold;
      state_.model.add(found.components);
    }
    cycle.from = state_.now;
    cycle.accuracy = state_.found_nothing
                         ? now().accuracy
                         : make_residual(state_.exact_from != 0 || rules_.is_likely_last(cycle)
                                             ? exact
                                             : rules_.accuracy_for_next(cycle.cycle_threshold_jy, noise_jy, now()));
    // A peak that is as bright as before, although it was cleaned, may be of the transform's making.
    if (cycle.accuracy != exact && reached_depth && peak_within_mask() > hardly_less * now().peak_residual_jy) {
      stay_exact();
      cycle.accuracy = make_residual(exact);
    }
    judge(std::move(cycle));
  }

  /// Keeps the cycle whose residual was made, or takes it back. Masks that grow let brighter pixels in: peaks are compared
  /// within the mask that the cycle had, and the mask grows only when it is kept.
  void judge(MajorCycle cycle) {
    const double before = o_.automask ? now().peak_residual_jy : best().peak_residual_jy;
    measure(cycle);
    const double peak = cycle.peak_residual_jy;
    if (!(peak <= grown * before)) return take_back(std::move(cycle));
    keep(std::move(cycle));
    if (o_.automask || peak < before) {
      state_.best = state_.now;
      state_.best_model = state_.model;
    }
  }

  static std::string description(MinorCycleEnd end) {
    switch (end) {
      case MinorCycleEnd::threshold:
        return "reached its depth";
      case MinorCycleEnd::iterations:
        return "found as many components as allowed";
      case MinorCycleEnd::diverging:
        return "its peak grew threefold";
      case MinorCycleEnd::stopped:
        return "stopped by the user";
      case MinorCycleEnd::no_place:
        return "no scale fits what is left";
    }
    return "";
  }

  /// Takes a cycle back. The first time coarser transforms may have misled CLEAN; after that its minor cycles go too deep.
  void take_back(MajorCycle cycle) {
    cycle.ended += "; the residual grew, taken back";
    state_.cycles.push_back(std::move(cycle));
    const bool may_be_misled = state_.exact_from == 0 && !input_.coarser.empty();
    if (may_be_misled)
      stay_exact();
    else
      ++state_.tightened;
    return_to_best();
    if (state_.exact_from != 0) make_exact();
  }

  void return_to_best() {
    state_.model = state_.best_model;
    state_.now = state_.best;
    make_residual(now().accuracy);
  }

  CleanResult result() {
    CleanResult result;
    result.residual = std::move(residuals_.front());
    result.further_residuals.assign(std::make_move_iterator(residuals_.begin() + 1), std::make_move_iterator(residuals_.end()));
    result.model = state_.model.image(o_.threads);
    for (int t = 1; t < input_.expansion.terms; ++t) result.further_models.push_back(state_.model.image(o_.threads, t));
    result.report.iterations = now().iterations;
    result.report.stop = end_->stop;
    result.report.stop_reason = end_->reason;
    result.report.max_sidelobe = input_.max_sidelobe;
    result.report.kept = state_.now;
    result.report.cycles = std::move(state_.cycles);
    result.components = std::move(state_.model);
    result.mask = std::move(state_.mask.allowed);
    return result;
  }

  CleanInput input_;
  const MinorCycle& minor_;
  const CleanOptions& o_;
  const Context& context_;
  ModelSharer sharer_;
  CleanState state_;
  CycleRules rules_;
  std::vector<Image> residuals_;  ///< [term], of state_.model
  ImageStatistics statistics_;    ///< of the first
  std::optional<CleanEnding> end_;
};

}  // namespace

CleanResult clean(CleanInput input, const MinorCycle& minor, const CleanOptions& options, CleanState state,
                  const CycleProgress& cycle_progress, const Context& context) {
  return Run(std::move(input), minor, options, std::move(state), context).run(cycle_progress);
}

}  // namespace misfit::imager
