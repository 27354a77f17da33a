#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include "ms_io/simulated_set.h"

namespace misfit::ms_io {

/// Fills every required subtable of `set`, which are empty, for one spectral window and XX and YY.
void fill_subtables(casacore::MeasurementSet& set, const SimulatedObservation& observation);

}  // namespace misfit::ms_io
