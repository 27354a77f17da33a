#pragma once

#include <string>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {

/// Throws std::runtime_error that names the header of a tiled storage manager of casacore, of the table at `path`, where it
/// states more than it and the files of tiles beside it can hold, tiles without length, or files and hypercubes that do not
/// exist: casacore takes memory by these numbers, divides by them and looks there. Throws Malformed where it ends too early, or
/// is no such header, which is for casacore to refuse.
void check_tiled_header(const std::string& path, const TableFile& table, const StorageManager& manager);

}  // namespace misfit::ms_io
