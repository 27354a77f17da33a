#pragma once

namespace misfit::tools {

inline constexpr double gib = 1024.0 * 1024 * 1024;

/// Bytes of memory this machine has.
double physical_memory_bytes();

/// The most memory that this process has held so far, in bytes.
double peak_memory_bytes();

}  // namespace misfit::tools
