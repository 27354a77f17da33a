#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/clean/clean.h"
#include "imager/clean/finite_images.h"
#include "imager/clean/mask.h"
#include "imager/clean/shared_model.h"
#include "imager/data/noise.h"
#include "imager/taylor/taylor_imaging.h"

namespace misfit::imager {
namespace {

constexpr double grown = 1.5;   // a residual this many times the best is taken back
constexpr double diverged = 3;  // tclean's factor between its codes
constexpr int most_tightenings = 3;
constexpr double exact = 0;          // accuracy of transforms that are as exact as any
constexpr std::size_t patience = 5;  // cycles without any progress

std::string in_jy(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g Jy/beam", value);
  return text;
}

std::vector<const Image*> pointers_to(const std::vector<Image>& images) {
  std::vector<const Image*> pointers;
  for (const Image& image : images) pointers.push_back(&image);
  return pointers;
}

struct Ending {
  CleanStop stop;
  std::string reason;
};

void require_same_terms(const CleanInput& input, const MinorCycle& minor) {
  const auto terms = static_cast<std::size_t>(input.expansion.terms);
  if (static_cast<std::size_t>(minor.terms()) != terms || input.dirty.size() != terms || input.psf.size() != 2 * terms - 1)
    throw std::invalid_argument(std::to_string(terms) + " Taylor terms, dirty images of " + std::to_string(input.dirty.size()) +
                                ", " + std::to_string(input.psf.size()) + " PSFs and a minor cycle of " +
                                std::to_string(minor.terms()) +
                                " terms; expected as many of each, and a PSF for each sum of two");
}

/// One run of CLEAN.
class Run {
 public:
  Run(CleanInput input, const MinorCycle& minor, const CleanOptions& options, CleanState state, const Context& context)
      : input_(std::move(input)),
        minor_(minor),
        o_(options),
        context_(context),
        sharer_(input_.imaged.samples.source.ranks()),
        state_(std::move(state)) {
    require_same_terms(input_, minor);
    if (state_.model.scale_pixels() != minor.scale_pixels())
      throw std::invalid_argument("a model of other scales than those of the minor cycle");
    for (const Image* psf : input_.psf) require_finite_psf(*psf);
    psf_rms_ = root_mean_square(*input_.psf.front());
    far_sidelobe_ = largest_far_sidelobe(*input_.psf.front());
    dirty_ = statistics_of(input_.dirty.front(), o_.threads);
  }

  CleanResult run(const CycleProgress& cycle_progress) {
    if (state_.cycles.empty())
      begin();
    else
      make_residual(now().accuracy);
    cycle_progress(state_);
    while (true) {
      while (!(end_ = ending())) {
        one_cycle();
        cycle_progress(state_);
      }
      if (is_worse_than_best()) {
        return_to_best();
        make_exact();
        end_->reason += "; the best model was kept";
        break;
      }
      if (now().accuracy == exact) break;
      make_exact();
      stay_exact();
      if ((end_ = ending())) break;
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
    if (start.accuracy > accuracy_for_next(start.peak_residual_jy, start)) {
      start.accuracy = make_residual(exact);
      measure(start);
    }
    keep(std::move(start));
  }

  /// At the limit of iterations, or at the last depth for the second time, the first having left what sidelobes had hidden.
  bool is_likely_last(const MajorCycle& cycle) const {
    return cycle.iterations >= o_.max_iterations || (is_at_last_depth(now()) && cycle.cycle_threshold_jy <= last_depth(now()));
  }

  /// From here on no coarser transforms are taken, and what they had left does not count against CLEAN.
  void stay_exact() {
    if (state_.exact_from == 0) state_.exact_from = state_.cycles.size();
    state_.tightened = 0;
  }

  /// Makes the residual, and what was measured of it, as exact as any.
  void make_exact() {
    MajorCycle& cycle = state_.cycles[state_.now];
    if (cycle.accuracy == exact) return;
    make_residual(exact);
    cycle.accuracy = exact;
    measure(cycle);
  }

  /// How exact the residual of a model must be for minor cycles that follow one of this depth: its error shall be a small part
  /// of theirs. It is in proportion to images of the data and of the model as if their phases were random.
  double accuracy_for_next(double depth_jy, const MajorCycle& before) const {
    constexpr double less_noise = 0.5;  // it falls as sources go
    const bool trusted = components_are_trusted();
    const double small = trusted ? 0.05 : 0.02, fraction = trusted ? o_.min_psf_fraction : depth_fraction();
    const double next = std::max(fraction * depth_jy, less_noise * last_depth(before));
    double square = 0;
    for (const Component& c : state_.model.components()) square += c.flux_jy * c.flux_jy;
    const double visibilities_jy = std::max(input_.data_jy, std::sqrt(square));
    return small * next / std::max(psf_rms_ * visibilities_jy, dirty_.root_mean_square());
  }
  int coarser_of(double accuracy) const {
    const auto& coarser = input_.coarser;
    const auto enough = [accuracy](const CoarserTransform& c) { return c.accuracy <= accuracy; };
    const auto found = std::find_if(coarser.begin(), coarser.end(), enough);
    return found == coarser.end() ? -1 : static_cast<int>(found - coarser.begin());
  }

  /// True while no residual was made and the model is that which the dirty images are of.
  bool begins_with_dirty() const {
    return residuals_.empty() && (input_.of_start || (state_.model.components().empty() && state_.cycles.size() <= 1));
  }

  /// Returns with which accuracy.
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
    for (const Image& residual : residuals_) require_finite_residual(statistics_of(residual, o_.threads), dirty_);
    return accuracy;
  }
  std::vector<Image> model_images() const {
    const StageTimer timer(context_.times, stage::minor_cycles);
    std::vector<Image> images;
    for (int term = 0; term < input_.expansion.terms; ++term) images.push_back(state_.model.image(o_.threads, term));
    return images;
  }
  /// Of the first term, whose units and noise the thresholds are of.
  const Image& residual() const { return residuals_.front(); }

  bool mask_is_empty() const { return mask() != nullptr && imager::mask_is_empty(*mask()); }
  /// Of the whole image where the mask is empty.
  double peak_within_mask() const {
    const bool everywhere = mask() == nullptr || mask_is_empty();
    return everywhere ? statistics_of(residual(), o_.threads).largest_magnitude()
                      : largest_magnitude_within(*mask(), residual(), o_.threads);
  }

  /// What the residual is now.
  void measure(MajorCycle& cycle) {
    const StageTimer timer(context_.times, stage::statistics);
    cycle.rms_jy = robust_noise(residual(), o_.threads);
    cycle.peak_residual_jy = peak_within_mask();
    const ImageStatistics statistics = statistics_of(residual(), o_.threads);
    cycle.peak_anywhere_jy = statistics.largest_magnitude();
    cycle.mean_square_jy2 = std::pow(statistics.root_mean_square(), 2);
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
    const bool at_the_end = cycle.cycle_threshold_jy > 0 && cycle.cycle_threshold_jy <= last_depth(state_.cycles[cycle.from]);
    const double changed =
        100 * static_cast<double>(cycle.masked.added) / static_cast<double>(std::max<std::size_t>(before, 1));
    state_.mask.final = at_the_end && !cycle.masked.by_sidelobes && changed < o.min_percent_change;
  }

  /// What ends CLEAN before another minor cycle, if anything.
  std::optional<Ending> ending() const {
    if (mask_is_empty())
      return Ending{CleanStop::empty_mask, std::string(o_.automask ? "nothing in the residual exceeds the mask's thresholds"
                                                                   : "the mask allows no pixel") +
                                               "; the peak residual is that of the whole image"};
    if (o_.stop_requested && o_.stop_requested()) return Ending{CleanStop::user, "stopped by the user"};
    if (now().peak_residual_jy <= (1 + threshold_tolerance) * o_.threshold_jy)
      return Ending{CleanStop::threshold, "the peak residual reached the threshold"};
    if (o_.nsigma > 0 && now().peak_residual_jy <= o_.nsigma * now().rms_jy)
      return Ending{CleanStop::nsigma, "the peak residual reached nsigma times the noise"};
    if (now().iterations >= o_.max_iterations) return Ending{CleanStop::iteration_limit, "the iteration limit was reached"};
    if (o_.max_major_cycles >= 0 && static_cast<int>(state_.cycles.size()) > o_.max_major_cycles)
      return Ending{CleanStop::major_cycle_limit, "the limit of major cycles was reached"};
    if (state_.found_nothing) return Ending{CleanStop::no_change, "a minor cycle found nothing to clean"};
    if (state_.tightened > most_tightenings) return divergence();
    if (!progresses())
      return Ending{CleanStop::no_change,
                    "neither peak nor mean square of the residual fell in " + std::to_string(patience) + " major cycles"};
    return std::nullopt;
  }

  Ending divergence() const {
    constexpr double near = 10;
    const double grew_to = state_.cycles.back().peak_residual_jy;
    if (grew_to <= near * input_.accuracy * dirty_.largest_magnitude())
      return {CleanStop::no_change,
              "what is left, " + in_jy(grew_to) + ", is the error of the transforms; a smaller --accuracy goes deeper"};
    return {grew_to <= diverged * best().peak_residual_jy ? CleanStop::diverging_from_best : CleanStop::diverging,
            "the residual grew from " + in_jy(best().peak_residual_jy) + " to " + in_jy(grew_to) +
                " although minor cycles had been made less deep; the best model was kept"};
  }

  /// Whether one of the last cycles left a smaller peak, or less power, than all before them.
  bool progresses() const {
    const std::vector<MajorCycle>& cycles = state_.cycles;
    const std::size_t since = state_.exact_from == 0 ? 0 : state_.exact_from - 1;
    if (cycles.size() - since <= patience) return true;
    const auto first = cycles.begin() + static_cast<std::ptrdiff_t>(since);
    const auto recent = cycles.end() - static_cast<std::ptrdiff_t>(patience);
    const auto fell = [&](double MajorCycle::*what) {
      const auto less = [what](const MajorCycle& a, const MajorCycle& b) { return a.*what < b.*what; };
      return (*std::min_element(recent, cycles.end(), less)).*what < (*std::min_element(first, recent, less)).*what;
    };
    return fell(&MajorCycle::peak_residual_jy) || fell(&MajorCycle::mean_square_jy2);
  }

  /// The depth to which the next minor cycle goes in any case: where the sidelobes of the brightest source could pass for
  /// sources.
  double sure_depth() const { return std::max(depth_fraction() * now().peak_residual_jy, last_depth(now())); }
  /// True while minor cycles may go deeper than the largest sidelobe allows: the PSF's far sidelobes are faint beside its near
  /// ones, and every residual so far came out nearly as its minor cycle promised.
  bool components_are_trusted() const {
    constexpr double far_less = 0.25, nearly = 1.5;
    const DoubtfulSidelobes doubtful = doubtful_sidelobes();
    if (!(std::max(doubtful.of_many, doubtful.of_one) <= far_less * o_.cycle_factor * input_.max_sidelobe)) return false;
    if (state_.tightened > 0 || state_.exact_from != 0) return false;
    return std::all_of(state_.cycles.begin(), state_.cycles.end(), [](const MajorCycle& cycle) {
      return cycle.cycle_threshold_jy == 0 || cycle.peak_residual_jy <= nearly * cycle.cycle_threshold_jy;
    });
  }
  /// The depth that the next minor cycle does not pass. Above it, it ends where sidelobes of all that it found could pass for
  /// sources.
  double deepest() const {
    if (!components_are_trusted()) return sure_depth();
    return std::max(o_.min_psf_fraction * now().peak_residual_jy, last_depth(now()));
  }
  /// Far from the phase centre sidelobes differ from the PSF's, and beyond half the image the PSF has none. Those of many
  /// sources leave no more than if none were taken off at all; those of one no more than the largest that lie far from it.
  DoubtfulSidelobes doubtful_sidelobes() const {
    constexpr double deviations = 6;
    return {.of_many = deviations * o_.cycle_factor * psf_rms_, .of_one = o_.cycle_factor * far_sidelobe_};
  }
  double depth_fraction() const {
    const double fraction = std::clamp(o_.cycle_factor * input_.max_sidelobe, o_.min_psf_fraction, o_.max_psf_fraction);
    return 1 - std::ldexp(1 - fraction, -state_.tightened);
  }
  /// True if the minor cycle that left this state went as deep as threshold and nsigma ask.
  bool is_at_last_depth(const MajorCycle& cycle) const {
    return cycle.cycle_threshold_jy > 0 && cycle.cycle_threshold_jy <= std::max(o_.threshold_jy, o_.nsigma * cycle.rms_jy);
  }
  /// The depth below which threshold and nsigma let no minor cycle go. Cycles that chase them by less than five percent are
  /// wasted: below nsigma all go by as much, since the noise falls as sources go, and below the threshold those that follow one
  /// that went down to it.
  double last_depth(const MajorCycle& begun) const {
    constexpr double deeper = 0.95;
    return std::max((is_at_last_depth(begun) ? deeper : 1) * o_.threshold_jy, deeper * o_.nsigma * begun.rms_jy);
  }

  void one_cycle() {
    constexpr double hardly_less = 0.9;
    MajorCycle cycle;
    const double deepest = this->deepest();
    const int left = o_.max_iterations - now().iterations;
    bool reached_depth = false;
    {
      const StageTimer timer(context_.times, stage::minor_cycles);
      const MinorCycleReport found = minor_.clean(
          pointers_to(residuals_), {.gain = o_.gain,
                                    .max_iterations = o_.cycle_iterations < 0 ? left : std::min(left, o_.cycle_iterations),
                                    .threshold_jy = deepest,
                                    .doubtful = doubtful_sidelobes(),
                                    .sure_jy = sure_depth(),
                                    .mask = mask(),
                                    .to_the_last = deepest <= last_depth(now()),
                                    .stop_requested = o_.stop_requested});
      state_.found_nothing = found.components.empty();
      cycle.iterations = now().iterations + found.iterations();
      cycle.cycle_threshold_jy = found.depth_jy;
      cycle.ended = description(found.end);
      reached_depth = found.end == MinorCycleEnd::threshold;
      state_.model.add(found.components);
    }
    cycle.from = state_.now;
    cycle.accuracy = state_.found_nothing ? now().accuracy
                                          : make_residual(state_.exact_from != 0 || is_likely_last(cycle)
                                                              ? exact
                                                              : accuracy_for_next(cycle.cycle_threshold_jy, now()));
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

  /// The first time it may be coarser transforms that misled CLEAN; after that its minor cycles go too deep.
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

  /// Cycles may leave somewhat more than the best, on the way to less. CLEAN shall not end there. Masks that grow compare
  /// nothing.
  bool is_worse_than_best() const {
    return !o_.automask && now().peak_residual_jy > best().peak_residual_jy && now().mean_square_jy2 > best().mean_square_jy2;
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
  std::vector<Image> residuals_;  ///< [term], of state_.model
  std::optional<Ending> end_;
  double psf_rms_ = 0;
  double far_sidelobe_ = 0;  ///< the largest from a quarter of the image on
  ImageStatistics dirty_;
};

}  // namespace

CleanResult clean(CleanInput input, const MinorCycle& minor, const CleanOptions& options, CleanState state,
                  const CycleProgress& cycle_progress, const Context& context) {
  return Run(std::move(input), minor, options, std::move(state), context).run(cycle_progress);
}

}  // namespace misfit::imager
