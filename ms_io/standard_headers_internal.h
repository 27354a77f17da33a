#pragma once

#include <string>

#include "ms_io/table_file_internal.h"

namespace misfit::ms_io {

/// Throws std::runtime_error that names a file of casacore's StandardStMan, of the table at `path`, where it states buckets,
/// rows, texts or arrays that it does not hold: casacore takes memory for them, or looks where there are none. Throws Malformed
/// where the header ends too early, which is for casacore to refuse.
void check_standard_header(const std::string& path, const TableFile& table, const StorageManager& manager);

}  // namespace misfit::ms_io
