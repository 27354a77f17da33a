#include "imager/clean/cycle_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace misfit::imager {
namespace {

constexpr double deeper = 0.95;
constexpr double diverged = 3;  // tclean's factor between its codes
constexpr int most_tightenings = 3;
constexpr std::size_t patience = 5;  // cycles without any progress

std::string in_jy(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g Jy/beam", value);
  return text;
}

/// With w, sidelobes of sources far from the phase centre differ from the PSF's: those of many sources leave no more than if
/// none were taken off at all, and those of one source no more than the largest far sidelobes. Without w the PSF lacks only
/// sidelobes beyond half the image, which resemble the last ones that it has.
DoubtfulSidelobes doubtful_sidelobes(const CleanInput& input, double psf_rms, double cycle_factor) {
  constexpr double deviations = 6, far = 0.25, last = 0.375;
  const FarSidelobes sidelobes = far_sidelobes(*input.psf.front(), input.same_sidelobes ? last : far);
  const double rms = input.same_sidelobes ? sidelobes.root_mean_square : psf_rms;
  return {.of_many = deviations * cycle_factor * rms, .of_one = cycle_factor * sidelobes.largest};
}

}  // namespace

CycleRules::CycleRules(const CleanInput& input, const CleanOptions& options, const CleanState& state)
    : o_(options),
      state_(state),
      max_sidelobe_(input.max_sidelobe),
      data_jy_(input.data_jy),
      accuracy_(input.accuracy),
      psf_rms_(root_mean_square(*input.psf.front())),
      doubtful_(doubtful_sidelobes(input, psf_rms_, options.cycle_factor)),
      dirty_(statistics_of(input.dirty.front(), options.threads)) {}

MinorCycleOptions CycleRules::next() const {
  const double peak = now().peak_residual_jy, sure = std::max(depth_fraction() * peak, last_threshold(now()));
  const double deepest = components_are_trusted() ? std::max(o_.min_psf_fraction * peak, last_threshold(now())) : sure;
  const int left = o_.max_iterations - now().iterations;
  return {.gain = o_.gain,
          .max_iterations = o_.cycle_iterations < 0 ? left : std::min(left, o_.cycle_iterations),
          .threshold_jy = deepest,
          .nsigma = deeper * o_.nsigma,
          .noise_jy = now().rms_jy,
          .doubtful = doubtful_,
          .sure_jy = sure,
          .to_the_last = deepest <= last_threshold(now()),
          .stop_requested = o_.stop_requested};
}

/// True while minor cycles may go deeper than the largest sidelobe allows: the PSF's far sidelobes are faint beside its near
/// ones, and every residual so far came out nearly as its minor cycle promised.
bool CycleRules::components_are_trusted() const {
  constexpr double far_less = 0.25, nearly = 1.5;
  if (!(std::max(doubtful_.of_many, doubtful_.of_one) <= far_less * o_.cycle_factor * max_sidelobe_)) return false;
  if (state_.tightened > 0 || state_.exact_from != 0) return false;
  return std::all_of(state_.cycles.begin(), state_.cycles.end(), [](const MajorCycle& cycle) {
    return cycle.cycle_threshold_jy == 0 || cycle.peak_residual_jy <= nearly * cycle.cycle_threshold_jy;
  });
}

double CycleRules::depth_fraction() const {
  const double fraction = std::clamp(o_.cycle_factor * max_sidelobe_, o_.min_psf_fraction, o_.max_psf_fraction);
  return 1 - std::ldexp(1 - fraction, -state_.tightened);
}

/// True if the minor cycle that left this state went as deep as threshold and nsigma ask.
bool CycleRules::is_at_last_depth(const MajorCycle& cycle) const {
  return cycle.cycle_threshold_jy > 0 && cycle.cycle_threshold_jy <= std::max(o_.threshold_jy, o_.nsigma * cycle.rms_jy);
}

double CycleRules::last_threshold(const MajorCycle& begun) const {
  return (is_at_last_depth(begun) ? deeper : 1) * o_.threshold_jy;
}

double CycleRules::last_depth(const MajorCycle& begun) const {
  return std::max(last_threshold(begun), deeper * o_.nsigma * begun.rms_jy);
}

bool CycleRules::is_likely_last(const MajorCycle& cycle) const {
  return cycle.iterations >= o_.max_iterations || (is_at_last_depth(now()) && cycle.cycle_threshold_jy <= last_depth(now()));
}

double CycleRules::accuracy_for_next(double depth_jy, double noise_jy, const MajorCycle& before) const {
  constexpr double less_noise = 0.5;  // it falls as sources go
  const bool trusted = components_are_trusted();
  const double small = trusted ? 0.05 : 0.02, fraction = trusted ? o_.min_psf_fraction : depth_fraction();
  const double last = std::max(last_threshold(before), deeper * o_.nsigma * noise_jy);
  const double next = std::max(fraction * depth_jy, less_noise * std::min(last, depth_jy));
  double square = 0;
  for (const Component& c : state_.model.components()) square += c.flux_jy * c.flux_jy;
  const double visibilities_jy = std::max(data_jy_, std::sqrt(square));
  return small * next / std::max(psf_rms_ * visibilities_jy, dirty_.root_mean_square());
}

std::optional<CleanEnding> CycleRules::ending(bool mask_is_empty) const {
  if (mask_is_empty)
    return CleanEnding{CleanStop::empty_mask, std::string(o_.automask ? "nothing in the residual exceeds the mask's thresholds"
                                                                      : "the mask allows no pixel") +
                                                  "; the peak residual is that of the whole image"};
  if (o_.stop_requested && o_.stop_requested()) return CleanEnding{CleanStop::user, "stopped by the user"};
  if (now().peak_residual_jy <= (1 + threshold_tolerance) * o_.threshold_jy)
    return CleanEnding{CleanStop::threshold, "the peak residual reached the threshold"};
  if (o_.nsigma > 0 && now().peak_residual_jy <= o_.nsigma * now().rms_jy)
    return CleanEnding{CleanStop::nsigma, "the peak residual reached nsigma times the noise"};
  if (now().iterations >= o_.max_iterations) return CleanEnding{CleanStop::iteration_limit, "the iteration limit was reached"};
  if (o_.max_major_cycles >= 0 && static_cast<int>(state_.cycles.size()) > o_.max_major_cycles)
    return CleanEnding{CleanStop::major_cycle_limit, "the limit of major cycles was reached"};
  if (state_.found_nothing) return CleanEnding{CleanStop::no_change, "a minor cycle found nothing to clean"};
  if (state_.tightened > most_tightenings) return divergence();
  if (!progresses())
    return CleanEnding{CleanStop::no_change,
                       "neither peak nor mean square of the residual fell in " + std::to_string(patience) + " major cycles"};
  return std::nullopt;
}

CleanEnding CycleRules::divergence() const {
  constexpr double near = 10;
  const double grew_to = state_.cycles.back().peak_residual_jy;
  if (grew_to <= near * accuracy_ * dirty_.largest_magnitude())
    return {CleanStop::no_change,
            "what is left, " + in_jy(grew_to) + ", is the error of the transforms; a smaller --accuracy goes deeper"};
  return {grew_to <= diverged * best().peak_residual_jy ? CleanStop::diverging_from_best : CleanStop::diverging,
          "the residual grew from " + in_jy(best().peak_residual_jy) + " to " + in_jy(grew_to) +
              " although minor cycles had been made less deep; the best model was kept"};
}

/// True if one of the last cycles left a smaller peak, or less power, than all before them.
bool CycleRules::progresses() const {
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

bool CycleRules::is_worse_than_best() const {
  return !o_.automask && now().peak_residual_jy > best().peak_residual_jy && now().mean_square_jy2 > best().mean_square_jy2;
}

}  // namespace misfit::imager
