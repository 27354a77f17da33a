#pragma once

#include <string>

namespace misfit::ms_io {

/// Checks the table at `path`, and the tables that it refers to or that lie in its keywords, before casacore believes them.
/// Throws std::runtime_error that names the file where a column's storage manager has a path for a name, from which casacore
/// would load a library; where a file of the table is a pipe or a folder; and where lock file, `table.dat` or headers of
/// storage managers state more than their files hold: casacore takes memory for that, or looks there. Errors that casacore
/// finds itself are left to it.
void check_storage_managers(const std::string& path);

}  // namespace misfit::ms_io
