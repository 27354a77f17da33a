#pragma once

#include <string>

namespace misfit::ms_io {

/// Looks at the lock files of a table and its subtables: casacore 3.4 and 3.5 crash where it cannot read one, or where one
/// holds what no program writes. Throws std::runtime_error that names the file.
void check_lock_files(const std::string& table);

}  // namespace misfit::ms_io
