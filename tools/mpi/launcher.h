#pragma once

#include <cstdlib>

namespace misfit::tools {

/// Whether a launcher of MPI programs started this process: Open MPI's, or one that speaks PMI or PMIx, as srun may.
inline bool was_launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

}  // namespace misfit::tools
