#pragma once

#include <string>

#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// Of the fields of `selected`, seen from `centre`. Throws std::runtime_error when FIELD or ANTENNA cannot be read.
NearestField nearest_field(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected,
                           const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
