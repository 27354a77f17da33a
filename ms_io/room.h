#pragma once

#include <cstdint>
#include <string>

namespace misfit::ms_io {

/// Throws std::runtime_error where so many bytes are not free where `path` lies: casacore ends programs, or spoils tables,
/// whose disk is full.
void require_room(const std::string& path, std::uintmax_t bytes);

}  // namespace misfit::ms_io
