#include "imager/clean/brightness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// Counts places by their brightness, in steps up to the brightest.
class BrightnessCount {
 public:
  BrightnessCount(double lowest, double highest) : lowest_(lowest), per_step_(steps / (highest - lowest)), count_(steps) {}
  void add(double brightness) { ++count_[static_cast<std::size_t>(std::min(steps - 1.0, (brightness - lowest_) * per_step_))]; }
  void add(const BrightnessCount& o) {
    for (std::size_t i = 0; i < count_.size(); ++i) count_[i] += o.count_[i];
  }
  /// The lowest brightness that no more than `most` places exceed; a top step that holds too many by itself is taken whole.
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
        const float* row[most_taylor_terms];
        for (std::size_t t = 0; t < terms; ++t) row[t] = plane.row(t, r);
        set_merits(form, psf.terms(), row, 0, plane.width, merit.data());
        visit(piece, s, merit);
      }
    }
  });
}

}  // namespace

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

}  // namespace misfit::imager
