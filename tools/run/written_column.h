#pragma once

#include <string>

#include "ms_io/model_writer.h"

namespace misfit::tools {

/// The lines that a command prints once it has written a column: "a.ms: DATA − model of 5 772 visibilities in 2 886 of 3 782
/// rows written to RESIDUAL_DATA", and one each on rows that an earlier run wrote and on rows whose UVW are not finite.
std::string written_words(const std::string& path, const ms_io::ModelColumn& column, const ms_io::ModelWriteReport& report);

/// A warning that tells what `column` of the MeasurementSet at `path` holds in the rows and channels that are not selected,
/// once it is written. Empty where all are selected. Called before the column is written.
std::string unselected_warning(const std::string& path, const ms_io::Selection& selection, const ms_io::ModelColumn& column);

}  // namespace misfit::tools
