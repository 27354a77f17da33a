// Lets tests of imager/, hosts/ and tools/ take solved kernels from one cache, whose bits are those that solving gives.
#include <boost/test/unit_test.hpp>
#include <cstdlib>

#include "kernels/catalogue_internal.h"
#include "kernels/kernel_cache.h"

namespace {

/// ctest names the folder, and empties it before the first test; without it each kernel is solved.
struct KeptKernels {
  KeptKernels() {
    const char* const folder = std::getenv("MISFIT_CACHE");
    if (folder == nullptr) return;
    for (misfit::kernels::KernelFamily& family : misfit::kernels::changeable_catalogue())
      family = misfit::kernels::cached(family, folder);
  }
};

}  // namespace

BOOST_TEST_GLOBAL_FIXTURE(KeptKernels);
