#include "imager/clean.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "imager/big_array.h"
#include "imager/hogbom.h"
#include "imager/mask.h"
#include "imager/noise.h"

namespace misfit::imager {
namespace {

/// What components may be taken from: the residual itself where there is no mask.
std::shared_ptr<const Image> cleanable(const std::shared_ptr<const Image>& residual, const Image* mask) {
  return mask == nullptr ? residual : std::make_shared<const Image>(masked(*residual, *mask));
}

double finite_peak(const Image& residual) {
  const double peak = find_peak(residual).value;
  if (!std::isfinite(peak))
    throw std::runtime_error("the residual image's peak is " + std::to_string(peak) +
                             " Jy/beam, expected a finite number: the data or the model are too large");
  return std::abs(peak);
}

/// 0 where the mask allows nothing.
double masked_peak(const Image& image) {
  const double peak = std::abs(find_peak(image).value);
  return std::isnan(peak) ? 0 : peak;
}

struct Ending {
  CleanStop stop;
  std::string reason;
};

/// What ends CLEAN before another minor cycle, if anything.
std::optional<Ending> ending(const CleanOptions& o, const std::vector<MajorCycle>& cycles) {
  const MajorCycle& now = cycles.back();
  if (o.mask != nullptr && mask_is_empty(*o.mask)) return Ending{CleanStop::empty_mask, "the mask allows no pixel"};
  if (o.stop_requested && o.stop_requested()) return Ending{CleanStop::user, "stopped by the user"};
  if (now.peak_residual_jy <= o.threshold_jy) return Ending{CleanStop::threshold, "the peak residual reached the threshold"};
  if (o.nsigma > 0 && now.peak_residual_jy <= o.nsigma * now.rms_jy)
    return Ending{CleanStop::nsigma, "the peak residual reached nsigma times the noise"};
  if (now.iterations >= o.max_iterations) return Ending{CleanStop::iteration_limit, "the iteration limit was reached"};
  if (o.max_major_cycles >= 0 && static_cast<int>(cycles.size()) > o.max_major_cycles)
    return Ending{CleanStop::major_cycle_limit, "the limit of major cycles was reached"};
  if (cycles.size() > 1 && now.iterations == cycles[cycles.size() - 2].iterations)
    return Ending{CleanStop::no_change, "a minor cycle found nothing to clean"};
  return std::nullopt;
}

/// The depth of the next minor cycle: where the sidelobes of the brightest source could pass for sources. Five percent below
/// the nsigma limit, since the noise falls as sources go, and cycles that chase it by less are wasted.
double cycle_threshold(const CleanOptions& o, double max_sidelobe, const MajorCycle& now) {
  const double fraction = std::clamp(o.cycle_factor * max_sidelobe, o.min_psf_fraction, o.max_psf_fraction);
  return std::max({fraction * now.peak_residual_jy, o.threshold_jy, 0.95 * o.nsigma * now.rms_jy});
}

}  // namespace

double largest_sidelobe(const Image& psf, const Image& beam) {
  double largest = 0;
  for (std::size_t i = 0; i < psf.pixel.size(); ++i) largest = std::max(largest, std::abs(psf.pixel[i] - beam.pixel[i]));
  return largest;
}

CleanResult clean(const VisibilitySource& source, const Transform& transform, const DirtyImages& images, double max_sidelobe,
                  const CleanOptions& options, const Progress& progress, const CycleProgress& cycle_progress,
                  StageTimes& times) {
  constexpr double divergence = 3;  // tclean's factor
  CleanResult result{Image(images.dirty.width, images.dirty.height), {}, {}};
  // Residuals are made anew, never changed; the first is the dirty image.
  std::shared_ptr<const Image> residual(std::shared_ptr<void>(), &images.dirty);
  if (options.start_model != nullptr) {
    result.model = *options.start_model;
    residual = std::make_shared<const Image>(make_residual_image(source, transform, result.model, progress, times));
  }
  std::shared_ptr<const Image> to_clean;
  const auto take_state = [&](double depth) {
    const StageTimer timer(times, "statistics");
    const double peak = finite_peak(*residual);
    to_clean = cleanable(residual, options.mask);
    const double flux = std::accumulate(result.model.pixel.begin(), result.model.pixel.end(), 0.0);
    result.report.cycles.push_back({result.report.iterations, options.mask == nullptr ? peak : masked_peak(*to_clean),
                                    robust_noise(*residual), flux, depth});
  };
  result.report.max_sidelobe = max_sidelobe;
  take_state(0);
  Image best_model = result.model;
  auto best_residual = residual;
  std::optional<Ending> end;
  while (!(end = ending(options, result.report.cycles))) {
    const MajorCycle now = result.report.cycles.back();
    const double depth = cycle_threshold(options, max_sidelobe, now);
    const int left = options.max_iterations - now.iterations;
    {
      const StageTimer timer(times, "minor cycles");
      result.report.iterations +=
          hogbom(*to_clean, images.psf,
                 {.gain = options.gain,
                  .max_iterations = options.cycle_iterations < 0 ? left : std::min(left, options.cycle_iterations),
                  .threshold_jy = depth,
                  .threads = options.threads,
                  .stop_requested = options.stop_requested},
                 result.model)
              .iterations;
    }
    to_clean.reset();
    residual.reset();
    residual = std::make_shared<const Image>(make_residual_image(source, transform, result.model, progress, times));
    take_state(depth);
    cycle_progress(result.report.cycles.back());
    const std::vector<MajorCycle>& cycles = result.report.cycles;
    if (cycles.back().peak_residual_jy < cycles[result.report.kept].peak_residual_jy) {
      result.report.kept = cycles.size() - 1;
      best_model = result.model;
      best_residual = residual;
    } else if (!(cycles.back().peak_residual_jy <= divergence * cycles[result.report.kept].peak_residual_jy)) {
      end = Ending{CleanStop::diverging, "the residual grew to more than three times its smallest; the best model was kept"};
      result.model = std::move(best_model);
      residual = best_residual;
      break;
    }
  }
  BigMemory::release();
  to_clean.reset();
  result.residual = *residual;
  if (end->stop != CleanStop::diverging) result.report.kept = result.report.cycles.size() - 1;
  result.report.stop = end->stop;
  result.report.stop_reason = end->reason;
  return result;
}

}  // namespace misfit::imager
