#pragma once

#include <string>
#include <vector>

#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// The columns of all sets in words: "CORRECTED_DATA", or "CORRECTED_DATA of a.ms, DATA of b.ms".
std::string columns_text(const std::vector<ms_io::DataColumn>& columns);

/// The columns that visibilities are read from, why, which models were subtracted from them and, of one set, which columns
/// there are; `asked` is --datacolumn.
imager::Decision data_column_decision(const std::vector<ms_io::DataColumn>& columns, const std::string& asked);

/// A warning that sets are imaged from different columns which nobody named; else empty.
std::string unlike_columns_warning(const std::vector<ms_io::DataColumn>& columns, const std::string& asked);

/// The lines of an image's HISTORY: the command and the columns.
std::vector<std::string> history_of(const std::string& command_line, const std::vector<ms_io::DataColumn>& columns);

/// A warning that nothing has filled the column, or which of its windows and fields.
std::string zeros_warning(const ms_io::ZeroColumn& column);

}  // namespace misfit::tools
