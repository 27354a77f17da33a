#pragma once

#include <string>
#include <vector>

#include "ms_io/field_directions_internal.h"

namespace misfit::ms_io {

/// Sentences for users on the way of a field that moves: that the place from which a frame that turns with the Earth is seen is
/// in doubt, that casacore does not know how the Earth turned, or that rates are of another year. `first` is the field's first
/// moment.
std::vector<std::string> doubts_of_motion(const casacore::MeasurementSet& set, const FieldDirections& fields, int field,
                                          const Moment& first);

}  // namespace misfit::ms_io
