#pragma once

#include <string>

#include "ms_io/beam_rows.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Adds what the rows of one more set tell about an image with this phase centre; pairs even where there is one sort. Throws
/// std::runtime_error where ANTENNA, FEED, FIELD or the columns of antennas and feeds cannot be read, rows name antennas that
/// ANTENNA lacks, or there are more than 256 sorts.
void add_beam_rows(const OpenSet& open_set, const imager::SkyDirection& centre, BeamRows& rows);

}  // namespace misfit::ms_io
