#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>

#include "ms_io/metadata_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/spectral_part_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The setup with those of its channels that may come into a range; `window` has their frequencies. The telescope's velocity
/// changes by 61 km/s in a year and a day, and the velocity of a source in its orbit about the Sun by some 300 km/s more at the
/// most; interpolation takes a channel beyond.
Setup between(const Setup& setup, const SpectralWindow& window, const FrequencyRange& range, bool of_source) {
  const double doppler = (of_source ? 400e3 : 61e3) / 2.99792458e8;
  Setup part = setup;
  part.channels.clear();
  part.frequency_hz.clear();
  part.channel_width_hz.clear();
  std::size_t c = 0;
  for (const Run& run : setup.channels)
    for (std::uint64_t channel = run.first; channel < run.first + run.count; ++channel, ++c) {
      const double margin_hz = doppler * window.frequency_hz[c] + 1.5 * window.channel_width_hz[c];
      if (window.frequency_hz[c] < range.low_hz - margin_hz || window.frequency_hz[c] > range.high_hz + margin_hz) continue;
      append(part.channels, channel);
      part.frequency_hz.push_back(setup.frequency_hz[c]);
      part.channel_width_hz.push_back(setup.channel_width_hz[c]);
    }
  return part;
}

double time_s(const OpenSet& set, std::uint64_t row) {
  return translated("cannot read TIME of " + set.path, [&] { return casacore::ScalarColumn<double>(set.set, "TIME")(row); });
}

}  // namespace

double first_time_s(const OpenSet& set) {
  return time_s(set, set.selected.first_row);
}

SpectralWindow window_at_first_row(const OpenSet& from, const Setup& setup) {
  SpectralWindow window{from.path, setup.spectral_window, setup.frequency_hz, setup.channel_width_hz, {}};
  for (const Run& run : setup.channels)
    for (std::uint64_t c = 0; c < run.count; ++c) window.channel.push_back(static_cast<int>(run.first + c));
  if (from.selected.spectral_frame.empty()) return window;
  // An ephemeris may not tell of another field's times, nor of those of flagged rows.
  const bool of_source = from.selected.spectral_frame == source_frame;
  const std::uint64_t row = of_source ? from.selected.first_row_of_field.at(setup.field) : from.selected.first_row;
  const auto moving = from.selected.moving.find(setup.field);
  const double when_s = of_source && moving != from.selected.moving.end() ? moving->second.first_s : time_s(from, row);
  const double ratio = FrameRatio(from.set, from.path, from.selected, setup, observation_of(from.set, row)).at(when_s);
  for (double& hz : window.frequency_hz) hz *= ratio;
  for (double& hz : window.channel_width_hz) hz *= ratio;
  return window;
}

std::shared_ptr<const OpenSet> channels_between(const OpenSet& set, const FrequencyRange& range,
                                                const std::optional<FrequencyRange>& counted) {
  const auto part = std::make_shared<OpenSet>(set);
  SelectedRows& selected = part->selected;
  selected.rows = selected.samples = 0;
  const bool of_source = selected.spectral_frame == source_frame;
  for (Setup& setup : selected.setups) {
    const SpectralWindow window = window_at_first_row(set, setup);
    Setup before;
    if (counted) before = between(setup, window, *counted, of_source);
    setup = between(setup, window, range, of_source);
    if (!before.channels.empty()) setup.uncounted = {before.first_channel(), before.channel_span()};
  }
  const auto without = [&](const BlockRows& block) { return selected.setups[block.setup].channels.empty(); };
  selected.blocks.erase(std::remove_if(selected.blocks.begin(), selected.blocks.end(), without), selected.blocks.end());
  for (const BlockRows& block : selected.blocks) {
    selected.rows += block.rows;
    selected.samples += block.rows * selected.setups[block.setup].frequency_hz.size();
  }
  return selected.blocks.empty() ? nullptr : part;
}

}  // namespace misfit::ms_io
