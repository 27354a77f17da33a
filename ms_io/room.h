#pragma once

#include <cstdint>
#include <string>

namespace misfit::ms_io {

/// Throws std::runtime_error where the disk of `path` does not have so many bytes free: casacore ends programs, or spoils
/// tables, whose disk is full.
void require_room(const std::string& path, std::uintmax_t bytes);

}  // namespace misfit::ms_io
