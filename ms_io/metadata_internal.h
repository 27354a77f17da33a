#pragma once

#include <string>

#include "imager/observation.h"
#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// What the image header says of the rows selected. Throws std::runtime_error when their fields have phase centres more than
/// 1e-9 rad apart, or one in a frame that cannot be converted to J2000.
imager::Observation describe(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected);

}  // namespace misfit::ms_io
