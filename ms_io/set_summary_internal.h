#pragma once

#include "ms_io/measurement_set.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// See MeasurementSet::summaries().
SetSummary summary_of(const OpenSet& open_set);

}  // namespace misfit::ms_io
