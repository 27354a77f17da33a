#pragma once

#include <vector>

#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Position angles of the zenith [row], from north through east, seen from where each row's field points in the frame of
/// `centre`: by these dishes turn that stand on alt-azimuth mounts. 0 of other mounts. The rows are in the order of blocks.
/// Throws std::runtime_error where ANTENNA, FIELD or the rows' times cannot be read.
std::vector<float> zenith_turns(const OpenSet& open_set, const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
