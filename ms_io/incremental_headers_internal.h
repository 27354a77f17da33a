#pragma once

#include <string>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {

/// check_standard_header() for casacore's IncrementalStMan, which keeps a value once for the rows that share it.
void check_incremental_header(const std::string& path, const TableFile& table, const StorageManager& manager);

}  // namespace misfit::ms_io
