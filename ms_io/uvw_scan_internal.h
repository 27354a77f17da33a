#pragma once

#include <functional>

#include "imager/data/extent.h"
#include "ms_io/measurement_set.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// See MeasurementSet::reach().
imager::UvwReach scan_uvw(const OpenSet& open_set, ReachOf rows);
/// See MeasurementSet::visit_coordinates().
void visit_uvw(const OpenSet& open_set, const std::function<void(const imager::SampleCoordinates&)>& visit);

}  // namespace misfit::ms_io
