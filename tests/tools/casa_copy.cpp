#include "tests/tools/casa_copy.h"

#include <casacore/casa/Logging/LogFilter.h>
#include <casacore/casa/Logging/LogSink.h>
#include <casacore/images/Images/FITSImage.h>
#include <casacore/images/Images/PagedImage.h>

namespace misfit::tools::testing {

void copy_to_casa(const std::string& fits, const std::string& path) {
  casacore::LogSink::globalSink().filter(casacore::LogFilter(casacore::LogMessage::SEVERE));
  const casacore::FITSImage from(fits);
  casacore::PagedImage<float> to(casacore::TiledShape(from.shape()), from.coordinates(), path);
  to.put(from.get());
  to.setUnits(from.units());
}

}  // namespace misfit::tools::testing
