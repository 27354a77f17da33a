#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// The TIMEs of a field's selected rows, as the set stores them.
struct FieldTimes {
  std::vector<double> used;  ///< of rows that are not flagged or, where all are, of all; different, ascending, finite
  std::vector<double> idle;  ///< of flagged rows alone, which may be any; different, ascending, and not finite ones last
};

/// The times of each of `fields`. Throws std::runtime_error for a row that is not flagged and whose TIME is not finite.
std::map<int, FieldTimes> times_of(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected,
                                   const std::set<int>& fields);

/// The OBSERVATION_IDs of the selected rows, of one field where it is given; 0 where OBSERVATION has no more than one row.
std::set<int> observations_of(const casacore::MeasurementSet& set, const SelectedRows& selected,
                              std::optional<int> of_field = {});

}  // namespace misfit::ms_io
