#include <stdexcept>

#include "tools/mpi/launcher.h"
#include "tools/mpi/world.h"

namespace misfit::tools {

class World::Mpi {};

World::World() {
  if (was_launched())
    throw std::runtime_error(
        "misfit was started by a launcher of MPI programs, but was built without MPI; expected to be started alone");
}

World::~World() = default;

const imager::Ranks& World::ranks() const {
  return imager::alone();
}

void World::end_all(int) const {}

std::string mpi_version() {
  return "";
}

}  // namespace misfit::tools
