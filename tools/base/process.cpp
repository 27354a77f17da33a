#include "tools/base/process.h"

#include <malloc.h>

#include <cstdlib>

namespace misfit::tools {

void prepare_process() {
  constexpr int most = 32 << 20;  // glibc takes no larger blocks from its heap: images of a major cycle reuse others' memory
  mallopt(M_MMAP_THRESHOLD, most);
  mallopt(M_TRIM_THRESHOLD, most);
  setenv("HOME", "/", 0);  // casacore looks for its settings there
}

}  // namespace misfit::tools
