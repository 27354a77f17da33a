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
  std::string remark;              ///< a sentence for users; mostly empty
};

/// Groups rows by the mean direction of both antennas in POINTING, see PointingTable. In the order of the table, a row belongs
/// to the pointing of the row before if it pointed within the tolerance of it; else to the first pointing of which that is so;
/// else it founds one where it pointed. Rows that are flagged or of one antenna found none, and belong to the pointing of the
/// row before. Throws what PointingTable does, and std::invalid_argument unless the tolerance is positive.
RowPointings row_pointings(const OpenSet& open_set, const imager::SkyDirection& centre, double tolerance_rad);

}  // namespace misfit::ms_io
