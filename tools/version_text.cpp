#include "tools/version_text.h"

#include <Eigen/Core>

#include "imager/files/fits_file.h"
#include "imager/numerics/fft.h"
#include "imager/numerics/instruction_set.h"
#include "kernels/version.h"
#include "ms_io/casacore_version.h"
#include "tools/build_facts.h"
#include "tools/mpi/world.h"

namespace misfit::tools {
namespace {

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + '.' + std::to_string(EIGEN_MAJOR_VERSION) + '.' +
         std::to_string(EIGEN_MINOR_VERSION);
}

std::string build() {
  std::string text = std::string(build_facts.compiler) + ", " + build_facts.build_type;
  if (*build_facts.sanitizers != '\0') text += std::string(", sanitizers ") + build_facts.sanitizers;
  return text;
}

}  // namespace

std::string version_text() {
  std::string text = "misfit " MISFIT_VERSION;
  const auto add = [&text](const char* fact, const std::string& value) {
    constexpr std::size_t column = 10;
    if (!value.empty()) text += '\n' + std::string(fact).append(column - std::string(fact).size(), ' ') + value;
  };
  add("commit", build_facts.commit);
  add("build", build());
  add("casacore", ms_io::casacore_version());
  add("CFITSIO", imager::cfitsio_version());
  add("FFTW", imager::fftw_library_version());
  add("Eigen", eigen_version());
  add("MPI", mpi_version());
  add("Highway", imager::highway_version() + ", loops run with " + imager::instruction_set());
  return text;
}

}  // namespace misfit::tools
