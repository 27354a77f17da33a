#pragma once

#include <memory>
#include <optional>

#include "ms_io/measurement_set.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// TIME of the earliest selected row, as the set stores it.
double first_time_s(const OpenSet& set);

/// The setup's channels in the frame of the selection, when the set's earliest selected row was observed.
SpectralWindow window_at_first_row(const OpenSet& from, const Setup& setup);

/// See MeasurementSet::part(); null where no channel of the set may come into the range.
std::shared_ptr<const OpenSet> channels_between(const OpenSet& set, const FrequencyRange& range,
                                                const std::optional<FrequencyRange>& counted);

}  // namespace misfit::ms_io
