#pragma once

#include <cstdint>
#include <string>

namespace misfit::ms_io {

/// Checks the lock file of a table: casacore 3.4 and 3.5 crash where they cannot read it, or where it holds what no program
/// writes. Throws std::runtime_error that names the file. Returns how many rows it says the table has, which casacore believes
/// rather than the table itself; 0 where it does not say.
std::uint64_t check_lock_file(const std::string& table);

}  // namespace misfit::ms_io
