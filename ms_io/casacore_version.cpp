#include "ms_io/casacore_version.h"

#include <casacore/casa/version.h>

namespace misfit::ms_io {

std::string casacore_version() {
  return casacore::getVersion();
}

}  // namespace misfit::ms_io
