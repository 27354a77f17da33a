#pragma once

#include <string>

#include "ms_io/beam_rows.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Adds the rows of one more set, for an image with this phase centre; fills pairs even where there is one sort. Throws
/// std::runtime_error where ANTENNA, FEED, FIELD or the columns of antennas and feeds cannot be read, rows name antennas that
/// ANTENNA lacks, or there are more than 256 sorts.
void add_beam_rows(const OpenSet& open_set, const imager::SkyDirection& centre, BeamRows& rows);

/// The sort of each antenna, from ANTENNA. Throws std::runtime_error where it cannot be read.
std::vector<imager::AntennaSort> antenna_sorts(const OpenSet& open_set);

/// The largest beam offset in FEED of any feed, in use or not: no rows of the main table are read. Throws std::runtime_error
/// where FEED cannot be read.
double beam_offset_rad(const OpenSet& open_set);

}  // namespace misfit::ms_io
