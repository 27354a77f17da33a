#pragma once

#include "tests/tools/program.h"

namespace misfit::tools::testing {

inline bool has_mpi() {
  static const bool has =
      run({"--version"}).out.find("\nMPI ") != std::string::npos && Child({"--version"}, "mpirun").wait().code == 0;
  if (!has) BOOST_TEST_MESSAGE("skipped: the program was built without MPI, or there is no mpirun");
  return has;
}

/// The program in so many processes, on whatever cores there are. Open MPI loses memory in parts of it that are gone when the
/// leak sanitizer looks, which can thus not be told of them. After a ":", others that are started with the `first`.
inline Arguments ranks(int size, bool first = true) {
  const Arguments of_each{"-x", "ASAN_OPTIONS=detect_leaks=0", "-n", std::to_string(size), MISFIT_PROGRAM};
  return first ? Arguments{"--allow-run-as-root", "--oversubscribe", "--bind-to", "none"} + of_each : of_each;
}

inline void succeed_together(int size, const Arguments& arguments) {
  const Outcome outcome = Child(ranks(size) + arguments + Arguments{"--quiet"}, "mpirun").wait();
  BOOST_TEST_INFO(outcome.err);
  BOOST_REQUIRE_EQUAL(outcome.code, 0);
  BOOST_TEST(outcome.out == "");
}

}  // namespace misfit::tools::testing
