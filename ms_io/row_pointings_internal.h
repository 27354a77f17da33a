#pragma once

#include <string>
#include <vector>

#include "ms_io/beam_rows.h"
#include "ms_io/sight_numbers_internal.h"

namespace misfit::ms_io {

/// Where the antennas of selected rows pointed, in groups.
struct RowPointings {
  std::vector<FieldPointing> pointings;
  std::vector<NumberedRows> rows;  ///< numbered by places among the pointings, ascending
  std::string remark;              ///< what users should know, in a sentence; mostly empty
};

/// By POINTING, see PointingTable, where the mean of both antennas pointed. In the order of the table, a row belongs to the
/// pointing of the row before if it pointed no farther from there than the tolerance; else to the first pointing of which that
/// is so; else it founds one where it pointed. Rows that are flagged or of one antenna found none, and belong to that of the
/// row before. Throws what PointingTable does, and std::invalid_argument unless the tolerance is positive.
RowPointings row_pointings(const OpenSet& open_set, const imager::SkyDirection& centre, double tolerance_rad);

}  // namespace misfit::ms_io
