#pragma once

#include <cstdlib>

namespace misfit::tools {

/// True if a launcher of MPI programs started this process and others: Open MPI's, or one that speaks PMI or PMIx, as srun may.
/// A script that one process runs may start misfit again and again, which MPI does not allow.
inline bool was_launched() {
  const char* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (size != nullptr && std::atoi(size) == 1) return false;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

/// How many processes the launcher started together; 0 where it does not tell.
inline int launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* const size = std::getenv(name)) return std::atoi(size);
  return 0;
}

}  // namespace misfit::tools
