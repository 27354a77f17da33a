#pragma once

#include <memory>
#include <string>

#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// A warning that something else wrote to the data while the run read them; empty where none of their files changed.
std::string changed_files_warning(const ms_io::MeasurementSet& data);

/// Rethrows the exception being handled; a std::runtime_error that changed files may explain gets the warning. `data` may be
/// null.
[[noreturn]] void rethrow_with_changed_files(const ms_io::MeasurementSet* data);

}  // namespace misfit::tools
