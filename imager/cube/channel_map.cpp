#include "imager/cube/channel_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace misfit::imager {
namespace {

/// Channels by ascending frequency, in the frame of the image.
class Ladder {
 public:
  Ladder(const Channels& channels, double frame_ratio) : index_(channels.frequency_hz.size()) {
    std::iota(index_.begin(), index_.end(), std::size_t{0});
    if (!std::is_sorted(channels.frequency_hz.begin(), channels.frequency_hz.end()))
      std::stable_sort(index_.begin(), index_.end(),
                       [&](std::size_t a, std::size_t b) { return channels.frequency_hz[a] < channels.frequency_hz[b]; });
    for (const std::size_t c : index_) {
      frequency_hz_.push_back(channels.frequency_hz[c] * frame_ratio);
      width_hz_.push_back(channels.width_hz[c] * frame_ratio);
      widest_hz_ = std::max(widest_hz_, width_hz_.back());
    }
  }

  /// Ladder steps [first, end) from `low` up to, but without, `high`.
  std::pair<std::size_t, std::size_t> within(double low_hz, double high_hz) const {
    const auto at = [&](double hz) {
      return static_cast<std::size_t>(std::lower_bound(frequency_hz_.begin(), frequency_hz_.end(), hz) - frequency_hz_.begin());
    };
    return {at(low_hz), at(high_hz)};
  }

  /// The step whose channel covers a frequency: the nearest of the two beside it.
  std::optional<std::size_t> covering(double hz) const {
    const std::size_t above = within(hz, hz).first;
    std::optional<std::size_t> best;
    for (const std::size_t step : {above - 1, above})
      if (step < size() && std::abs(frequency_hz_[step] - hz) <= 0.5 * width_hz_[step] * (1 + rounding))
        if (!best || std::abs(frequency_hz_[step] - hz) < std::abs(frequency_hz_[*best] - hz)) best = step;
    return best;
  }

  /// The sample at a frequency.
  std::optional<ChannelTap> interpolated(double hz) const {
    const std::size_t above = within(hz, hz).first;
    if (above > 0 && above < size() && adjacent(above - 1)) {
      const double part = (hz - frequency_hz_[above - 1]) / (frequency_hz_[above] - frequency_hz_[above - 1]);
      if (part <= rounding) return alone(above - 1);
      if (part >= 1 - rounding) return alone(above);
      return ChannelTap{index_[above - 1], index_[above], part};
    }
    const std::optional<std::size_t> step = covering(hz);
    if (!step) return std::nullopt;
    return alone(*step);
  }

  /// From the lower edge of the lowest channel to the upper edge of the highest, at least.
  std::pair<double, double> reach_hz() const { return {frequency_hz_.front() - widest_hz_, frequency_hz_.back() + widest_hz_}; }
  std::size_t size() const { return index_.size(); }
  std::size_t channel(std::size_t step) const { return index_[step]; }
  /// The mean width of the channels that reach into a range; nothing where none does.
  std::optional<double> mean_width_hz(double low_hz, double high_hz) const {
    double sum = 0;
    int count = 0;
    const auto [first, end] = within(low_hz - 0.5 * widest_hz_, high_hz + 0.5 * widest_hz_);
    for (std::size_t step = first; step < end; ++step)
      if (frequency_hz_[step] + 0.5 * width_hz_[step] > low_hz && frequency_hz_[step] - 0.5 * width_hz_[step] < high_hz) {
        sum += width_hz_[step];
        ++count;
      }
    if (count == 0 || sum == 0) return std::nullopt;
    return sum / count;
  }

 private:
  static constexpr double rounding = 1e-6;  // of a channel: planes that lie on channels take these alone

  ChannelTap alone(std::size_t step) const { return {index_[step], index_[step], 0}; }
  /// True if no channel is missing between a step and the next.
  bool adjacent(std::size_t step) const {
    return frequency_hz_[step + 1] - frequency_hz_[step] <= 0.75 * (width_hz_[step] + width_hz_[step + 1]);
  }

  std::vector<std::size_t> index_;  ///< [step] channel
  std::vector<double> frequency_hz_, width_hz_;
  double widest_hz_ = 0;
};

PlaneChannels nearest(const SpectralAxis& axis, int plane, const Ladder& ladder, const Channels& channels) {
  const FrequencyBand edges = axis.planes(plane, 1);  // adjacent planes meet at the same number
  auto [first, end] = ladder.within(edges.low_hz, edges.high_hz);
  if (first == end) {
    const std::optional<std::size_t> step = ladder.covering(axis.frequency_hz(plane));
    if (!step) return {};
    first = *step;
    end = first + 1;
  }
  PlaneChannels taken;
  for (std::size_t step = first; step < end; ++step) {
    const std::size_t channel = ladder.channel(step);
    taken.frequency_hz.push_back(channels.frequency_hz[channel]);
    taken.tap.push_back({channel, channel, 0});
  }
  return taken;
}

PlaneChannels linear(const SpectralAxis& axis, int plane, const Ladder& ladder) {
  const FrequencyBand edges = axis.planes(plane, 1);  // adjacent planes meet at the same number
  const double middle = axis.in_wavelength ? edges.middle_hz() : axis.frequency_hz(plane);
  const double step_hz = axis.in_wavelength ? std::copysign(edges.width_hz(), axis.increment_hz) : axis.increment_hz;
  const std::optional<double> width = ladder.mean_width_hz(edges.low_hz, edges.high_hz);
  if (!width) return {};
  const double places = std::max(1.0, std::round(std::abs(step_hz) / *width));
  double first = 0, end = places;
  if (places > 1) {  // beside the channels there is nothing, however far a plane reaches
    const auto place_of = [&](double hz) { return ((hz - middle) / step_hz + 0.5) * places; };
    const auto [low_hz, high_hz] = ladder.reach_hz();
    const auto [one, other] = std::minmax({place_of(low_hz), place_of(high_hz)});
    first = std::max(first, std::floor(one) - 1);
    end = std::min(end, std::ceil(other) + 1);
  }
  PlaneChannels taken;
  for (double i = first; i < end; ++i) {
    const double hz = middle + ((i + 0.5) / places - 0.5) * step_hz;
    if (const std::optional<ChannelTap> tap = ladder.interpolated(hz)) {
      taken.frequency_hz.push_back(hz);
      taken.tap.push_back(*tap);
    }
  }
  return taken;
}

}  // namespace

ChannelMap map_channels(const CubeSampling& sampling, const PlaneRange& range, const Channels& channels, double frame_ratio) {
  const Ladder ladder(channels, frame_ratio);
  const bool interpolated = sampling.interpolation == SpectralInterpolation::linear;
  ChannelMap map;
  if (interpolated) map.uvw_scale = 1 / frame_ratio;
  for (int plane = range.first; plane < range.first + range.count; ++plane)
    map.planes.push_back(interpolated ? linear(sampling.axis, plane, ladder) : nearest(sampling.axis, plane, ladder, channels));
  return map;
}

}  // namespace misfit::imager
