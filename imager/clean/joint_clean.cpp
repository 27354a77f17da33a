#include "imager/clean/joint_clean.h"

#include <algorithm>
#include <cmath>

#include "imager/clean/bright_places.h"
#include "imager/clean/components.h"
#include "imager/clean/finite_images.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// How bright the places of a residual are, as BrightPlaces says.
struct Brightness {
  double points = 0;     ///< of the brightest point
  double brightest = 0;  ///< of the best place for a component
};

/// Counts places by their brightness, in steps up to the brightest.
class BrightnessCount {
 public:
  BrightnessCount(double lowest, double highest) : lowest_(lowest), per_step_(steps / (highest - lowest)), count_(steps) {}
  void add(double brightness) { ++count_[static_cast<std::size_t>(std::min(steps - 1.0, (brightness - lowest_) * per_step_))]; }
  void add(const BrightnessCount& o) {
    for (std::size_t i = 0; i < count_.size(); ++i) count_[i] += o.count_[i];
  }
  /// The lowest brightness that no more than `most` exceed; a top step that holds too many by itself is taken whole.
  double level_of(std::size_t most) const {
    std::size_t step = steps, above = 0;
    while (step > 0 && above + count_[step - 1] <= most) above += count_[--step];
    return lowest_ + static_cast<double>(std::min<std::size_t>(step, steps - 1)) / per_step_;
  }

 private:
  static constexpr int steps = 4096;
  double lowest_;
  double per_step_;
  std::vector<std::size_t> count_;
};

constexpr int rows_a_piece = 64;

std::size_t pieces_of(const ScaledResidual& residual) {
  return static_cast<std::size_t>((residual.height() + rows_a_piece - 1) / rows_a_piece);
}

/// Calls visit(piece, scale, merit of each place of a row [column]) for the rows of all scales. Threads share pieces of rows.
template <typename Visit>
void for_each_row(const ScaledResidual& residual, const ScaledPsf& psf, int threads, const Visit& visit) {
  const auto terms = static_cast<std::size_t>(psf.terms());
  parallel_for(pieces_of(residual), threads, [&](std::size_t piece) {
    std::vector<float> merit;
    for (std::size_t s = 0; s < psf.scales().size(); ++s) {
      const ScaledResidual::Plane& plane = residual.plane(s);
      const MeritForm& form = psf.scales()[s].form;
      merit.resize(static_cast<std::size_t>(plane.width));
      const int first = static_cast<int>(piece) * rows_a_piece / plane.step;
      for (int r = first; r < std::min(plane.height, first + rows_a_piece / plane.step); ++r) {
        std::fill(merit.begin(), merit.end(), 0.0F);
        for (std::size_t a = 0; a < terms; ++a)
          for (int c = 0; c < plane.width; ++c) {
            float y = 0;
            for (std::size_t q = 0; q <= a; ++q) y += form.row[a][q] * plane.row(q, r)[c];
            merit[static_cast<std::size_t>(c)] += y * y;
          }
        visit(piece, s, merit);
      }
    }
  });
}

Brightness brightness_of(const ScaledResidual& residual, const ScaledPsf& psf, int threads) {
  struct Merits {
    float point = 0, best = 0;
  };
  std::vector<Merits> of_piece(pieces_of(residual));
  for_each_row(residual, psf, threads, [&](std::size_t piece, std::size_t scale, const std::vector<float>& merit) {
    float most = 0;
    for (const float m : merit) most = m > most ? m : most;
    Merits& merits = of_piece[piece];
    if (scale == 0) merits.point = std::max(merits.point, most);
    if (psf.scales()[scale].looked_at.index >= 0) merits.best = std::max(merits.best, most);
  });
  Merits all;
  for (const Merits& merits : of_piece) all = {std::max(all.point, merits.point), std::max(all.best, merits.best)};
  return {std::sqrt(psf.scales().front().basis.peak() * all.point), std::sqrt(double{all.best})};
}

/// The lowest brightness, from `lowest` on, that no more than so many places exceed.
double level_for(const ScaledResidual& residual, const ScaledPsf& psf, double lowest, double highest, std::size_t most,
                 int threads) {
  if (!(highest > lowest)) return lowest;
  std::vector<BrightnessCount> of_piece(pieces_of(residual), BrightnessCount(lowest, highest));
  const auto least_merit = static_cast<float>(lowest * lowest);
  for_each_row(residual, psf, threads, [&](std::size_t piece, std::size_t, const std::vector<float>& merit) {
    for (const float m : merit)
      if (m >= least_merit) of_piece[piece].add(std::sqrt(m));
  });
  BrightnessCount all(lowest, highest);
  for (const BrightnessCount& count : of_piece) all.add(count);
  return all.level_of(most);
}

/// How far down components are found: until no point is brighter, where that is not 0, or no place is.
struct Depth {
  double points;
  double any;
};

/// Finds components among bright places to a depth, or until others may have become as bright. Returns the points' brightness.
double find_among(BrightPlaces& bright, const ScaledPsf& psf, const MinorCycleOptions& o, double unit_jy, const Depth& depth,
                  const MinorCycleWatch& watch, MinorCycleReport& report) {
  constexpr double bearable = 0.2;
  const double first = bright.brightness();
  do {
    const BrightPlaces::Place at = bright.brightest();
    const ScaledPsf::Scale& scale = psf.scales()[at.scale];
    TaylorValues y = scale.basis.coordinates(at.residual);
    for (double& of_term : y) of_term *= o.gain;
    const TaylorValues coefficient = scale.basis.coefficients(y);
    Component component{scale.looked_at.index, at.row, at.column, coefficient.front() * unit_jy};
    for (std::size_t t = 1; t < most_taylor_terms; ++t) component.further_jy[t - 1] = coefficient[t] * unit_jy;
    report.components.push_back(component);
    bright.subtract(at, coefficient);
    if (bright.outstanding() > bearable * bright.brightness() && !bright.subtract_outstanding()) break;
  } while ((depth.points == 0 || bright.point_brightness() > depth.points) &&
           bright.brightness() > std::max(depth.any, bright.of_others()) &&
           bright.brightness() <= minor_cycle_divergence * first && !watch.is_at_limit(report));
  return bright.point_brightness();
}

const MultiscaleOptions& checked(const std::vector<const Image*>& psf, const MultiscaleOptions& options) {
  check_scales(options);
  for (const Image* image : psf) require_finite_psf(*image);
  return options;
}

}  // namespace

JointClean::JointClean(const std::vector<const Image*>& psf, const MultiscaleOptions& options)
    : MinorCycle(*psf.front(), static_cast<int>(psf.size() + 1) / 2),
      options_(checked(psf, options)),
      psf_(psf, options),
      fft_(psf, psf_.looked_at(), options.threads) {}

MinorCycleReport JointClean::find(const std::vector<const Image*>& residual, const MinorCycleOptions& o) const {
  constexpr double as_good_as = 1.005;  // a convolution costs as much for the last pixels as for the first
  constexpr double deep = 3;            // places are looked at from this part of the threshold on
  constexpr double least_merit = 0.01;  // of a point's at the threshold: no scale sees what is left
  constexpr std::size_t least_places = 65536;
  const std::size_t most = std::max(least_places, residual.front()->pixel.size() / 128);
  const bool points = psf_.scales().front().looked_at.index >= 0;
  ScaledResidual left(residual, o.mask, psf_, fft_, options_.threads);
  const double unit = left.unit_jy(), threshold = o.threshold_jy / unit;
  MinorCycleReport report;
  Brightness now = brightness_of(left, psf_, options_.threads);
  const MinorCycleWatch watch(o, now.points * unit);
  while (!watch.ends(now.points * unit, report)) {
    if (report.iterations() > 0 && now.points <= as_good_as * threshold) {
      report.end = MinorCycleEnd::threshold;
      break;
    }
    if (!(now.brightest * now.brightest > least_merit * threshold * threshold)) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    // Without points to put there may be no place as bright as the brightest point.
    const double target = points ? threshold : std::min(threshold, now.brightest / 2);
    const double level = level_for(left, psf_, target / deep, now.brightest, most, options_.threads);
    const auto before = static_cast<std::ptrdiff_t>(report.components.size());
    BrightPlaces bright(left, psf_, level, options_.threads);
    if (bright.brightness() == 0) {
      report.end = MinorCycleEnd::no_place;
      break;
    }
    // Points end it only where all that exceed the threshold are in view.
    const bool sees_points = level <= threshold;
    const double peak = find_among(bright, psf_, o, unit,
                                   {sees_points ? threshold : 0, points ? level : std::max(level, target)}, watch, report);
    if (!o.to_the_last && sees_points && peak <= threshold) {
      report.peak_jy = peak * unit;
      report.end = MinorCycleEnd::threshold;
      break;
    }
    ComponentModel found(width(), height(), options_.scale_pixels);
    found.add({report.components.begin() + before, report.components.end()});
    left.subtract(found);
    now = brightness_of(left, psf_, options_.threads);
  }
  return report;
}

}  // namespace misfit::imager
