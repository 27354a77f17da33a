#pragma once

#include <string>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {

/// Throws std::runtime_error that names a file of casacore's StandardStMan, that of the table at `path`, where it tells of
/// buckets, rows, texts or arrays that it does not hold: casacore takes memory for them, or looks where there are none. What
/// ends too early in the header is for casacore to refuse (Malformed).
void check_standard_header(const std::string& path, const TableFile& table, const StorageManager& manager);

}  // namespace misfit::ms_io
