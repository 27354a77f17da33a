#pragma once

#include "imager/extent.h"
#include "ms_io/measurement_set.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// See MeasurementSet::reach().
imager::UvwReach scan_uvw(const OpenSet& open_set, ReachOf rows);

}  // namespace misfit::ms_io
