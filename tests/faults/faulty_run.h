#pragma once

#include "tests/faults/traced_process.h"
#include "tests/tools/program.h"

namespace misfit::tools::testing {

using misfit::testing::Answer, misfit::testing::SystemCall;

/// Of places where a fault is tried, the program as its users have it fails at each; sanitized, each run takes seconds.
#ifdef MISFIT_SANITIZED
constexpr std::size_t stride = 8;
#else
constexpr std::size_t stride = 1;
#endif

/// The program, while `answer` says what becomes of each of the `calls` that it makes.
inline Outcome run_with_faults(const Arguments& arguments, const std::vector<long>& calls,
                               const std::function<Answer(const SystemCall&)>& answer) {
  const TemporaryFolder folder;
  const std::string out = folder / "out", err = folder / "err", cache = kernel_cache();
  const auto action = [&] {
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // the leak sanitizer traces processes itself
    become(MISFIT_PROGRAM, arguments, out, err, cache);
  };
  const int code = misfit::testing::trace(action, calls, answer);
  return {code, content(out), content(err)};
}

}  // namespace misfit::tools::testing
