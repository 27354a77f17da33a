#pragma once

#include <functional>
#include <string>

#include "imager/data/extent.h"
#include "ms_io/measurement_set.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// See MeasurementSet::reach().
SetReach scan_uvw(const OpenSet& open_set, ReachOf rows);
/// See MeasurementSet::visit_coordinates().
void visit_uvw(const OpenSet& open_set, const std::function<void(const imager::SampleCoordinates&)>& visit);

/// 1 / √(u² + v² + w²), in wavelengths, of the sample with the longest baseline, among rows of two antennas that are not
/// flagged; 0 where all baselines are 0. It is taken from UVW, which is imaged: antennas' POSITION may be in another unit, or
/// absent.
double finest_beam_rad(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected);

}  // namespace misfit::ms_io
