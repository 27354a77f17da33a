#pragma once

#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// The data of an image in words, a line each: telescope and time, fields, spectral windows, and baselines, which is `reach`;
/// where there are several sets, one line for each of the first ten, and one for the baselines of all. Reads no visibility.
/// Throws what MeasurementSet::summaries() throws.
imager::Plan data_decisions(const ms_io::MeasurementSet& set, const ms_io::SetReach& reach);

}  // namespace misfit::tools
