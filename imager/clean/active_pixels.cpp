#include "imager/clean/active_pixels.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

/// The lowest level, not below `lowest`, above which no more than `most` pixels lie: a 4096th of the peak higher at most.
double level_for(const Image& residual, double lowest, double peak, std::size_t most) {
  constexpr int steps = 4096;
  if (!(peak > lowest)) return lowest;
  std::vector<std::size_t> count(steps);
  for (const double value : residual.pixel)
    if (const double magnitude = std::abs(value); magnitude >= lowest)
      ++count[static_cast<std::size_t>(std::min(steps - 1.0, (magnitude - lowest) / (peak - lowest) * steps))];
  std::size_t step = steps, above = 0;
  while (step > 0 && above + count[step - 1] <= most) above += count[--step];
  // A top step that holds too many by itself is taken whole.
  step = std::min<std::size_t>(step, steps - 1);
  return lowest + (peak - lowest) * static_cast<double>(step) / steps;
}

}  // namespace

double active_level(const Image& residual, double stop_jy, double largest_outside, std::size_t most) {
  const double peak = largest_magnitude(residual);
  return level_for(residual, std::max(stop_jy / 2, largest_outside * peak), peak, most);
}

ActivePixels::ActivePixels(const Image& residual, double stop_jy, const PsfCore& core, std::size_t most)
    : core_(core), level_jy_(active_level(residual, stop_jy, core.largest_outside(), most)) {
  row_.resize(static_cast<std::size_t>(residual.height) + 1);
  for (int r = 0; r < residual.height; ++r) {
    row_[static_cast<std::size_t>(r)].first = value_.size();
    for (int c = 0; c < residual.width; ++c)
      if (std::abs(residual.at(r, c)) >= level_jy_) {
        column_.push_back(c);
        value_.push_back(static_cast<float>(residual.at(r, c)));
      }
  }
  row_.back().first = value_.size();
  for (std::size_t r = 0; r + 1 < row_.size(); ++r) find_peak_of(r);
}

/// In lanes, so that no comparison waits for the one before.
void ActivePixels::find_peak_of(std::size_t row) {
  constexpr std::size_t lanes = 16;
  float peak[lanes];
  std::fill_n(peak, lanes, -1.0F);
  const std::size_t end = row_[row + 1].first;
  std::size_t i = row_[row].first;
  for (; i + lanes <= end; i += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const float magnitude = std::abs(value_[i + lane]);
      peak[lane] = magnitude > peak[lane] ? magnitude : peak[lane];
    }
  for (; i < end; ++i) peak[0] = std::max(peak[0], std::abs(value_[i]));
  row_[row].peak = *std::max_element(peak, peak + lanes);
}

Peak ActivePixels::peak() const {
  const auto brightest = std::max_element(row_.begin(), row_.end(), [](const Row& a, const Row& b) { return a.peak < b.peak; });
  if (brightest->peak < 0) return {};
  std::size_t i = brightest->first;
  while (std::abs(value_[i]) != brightest->peak) ++i;
  return {static_cast<int>(brightest - row_.begin()), column_[i], double{value_[i]}};
}

void ActivePixels::subtract(int row, int column, float factor) {
  const int reach = core_.reach(), rows = static_cast<int>(row_.size()) - 1;
  for (int r = std::max(0, row - reach); r <= std::min(rows - 1, row + reach); ++r) {
    const auto at = static_cast<std::size_t>(r);
    const auto begin = column_.begin() + static_cast<std::ptrdiff_t>(row_[at].first);
    const auto end = column_.begin() + static_cast<std::ptrdiff_t>(row_[at + 1].first);
    const auto first = std::lower_bound(begin, end, column - reach);
    if (first == end || *first > column + reach) continue;
    const float* const psf = core_.row(r - row);
    for (auto c = first; c != end && *c <= column + reach; ++c)
      value_[static_cast<std::size_t>(c - column_.begin())] -= factor * psf[*c - column];
    find_peak_of(at);
  }
}

void find_among(ActivePixels& active, const ActiveSearch& search, const MinorCycleWatch& watch, MinorCycleReport& report) {
  double taken = 0;  // Σ|component|, in Jy/beam
  Peak peak = active.peak();
  const double first = std::abs(peak.value);
  do {
    const double component = search.gain * peak.value;
    report.components.push_back({search.scale, peak.row, peak.column, component * search.flux_per_jy});
    active.subtract(peak.row, peak.column, static_cast<float>(component));
    taken += std::abs(component);
    peak = active.peak();
  } while (std::abs(peak.value) > std::max(search.stop_jy, active.level_jy() + active.core().largest_outside() * taken) &&
           std::abs(peak.value) <= minor_cycle_divergence * first && !watch.is_at_limit(report));
}

}  // namespace misfit::imager
