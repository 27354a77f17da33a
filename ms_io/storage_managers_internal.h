#pragma once

#include <string>

namespace misfit::ms_io {

/// Looks at the table at `path`, and at those that it refers to or that lie in its keywords, before casacore believes what they
/// say. Throws std::runtime_error that names the file where its columns are stored by a manager whose name is a path, from
/// which casacore would load a library; where a file of it is a pipe or a folder; and where lock file, `table.dat` or headers
/// of storage managers tell of what their files do not hold: casacore takes memory for that, or looks there. What casacore
/// refuses itself is left to it.
void check_storage_managers(const std::string& path);

}  // namespace misfit::ms_io
