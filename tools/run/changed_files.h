#pragma once

#include <memory>
#include <string>

#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// That something else wrote to the data while the run read them; empty where no file of theirs changed.
std::string changed_files_warning(const ms_io::MeasurementSet& data);

/// Throws what is being handled again, with that warning where it is a std::runtime_error that it may explain. `data` may be
/// null.
[[noreturn]] void rethrow_with_changed_files(const ms_io::MeasurementSet* data);

}  // namespace misfit::tools
