#pragma once

#include <vector>

#include "ms_io/beam_rows.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Of the fields that have selected rows, in the order of their ids, seen from `centre`. Throws std::runtime_error when FIELD
/// or ANTENNA cannot be read.
std::vector<FieldPointing> field_pointings(const OpenSet& open_set, const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
