#pragma once

#include <string>

#include "imager/observation.h"
#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// What the image header says of the rows selected. Throws std::runtime_error when their fields have phase centres more than
/// 1e-9 rad apart and are not shifted, or one in a frame that cannot be converted to J2000.
imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected);

/// TELESCOPE_NAME of the observation of `row`; empty where there is none.
std::string telescope_name(const casacore::MeasurementSet& set, std::uint64_t row);

/// What the header of one image of all says: the first, with the band of all. Throws std::runtime_error when two have different
/// phase centres; `paths` name them.
imager::Observation joined(const std::vector<imager::Observation>& observations, const std::vector<std::string>& paths);

}  // namespace misfit::ms_io
