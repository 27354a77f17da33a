#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "kernels/lookup_table.h"

// How decisions and refusals are worded.

namespace misfit::imager {

/// `value` as printf has it.
inline std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// "cubic tables of 64 entries a cell"
inline std::string text(const kernels::TableOptions& tables) {
  return std::string(kernels::interpolation_names[static_cast<std::size_t>(tables.interpolation)]) + " tables of " +
         std::to_string(tables.samples_per_cell) + " entries a cell";
}

}  // namespace misfit::imager
