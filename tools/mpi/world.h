#pragma once

#include <memory>
#include <string>

#include "imager/data/ranks.h"

namespace misfit::tools {

/// The processes that mpirun, or another launcher of MPI programs, started together; this one alone where none did. Made once,
/// in main, which lives until it ends.
class World {
 public:
  /// Joins the others. Throws std::runtime_error where this program was built without MPI and there are others.
  World();
  /// Waits until all are here.
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const imager::Ranks& ranks() const;
  /// Ends all processes with this exit code, at once: others may wait for this one, which will not come. Returns where there
  /// are no others.
  void end_all(int exit_code) const;

 private:
  class Mpi;
  std::unique_ptr<Mpi> mpi_;  ///< null where there are no others
};

/// The version of MPI's library; empty where this program was built without MPI.
std::string mpi_version();

}  // namespace misfit::tools
