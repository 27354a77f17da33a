#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "tools/base/interrupt.h"
#include "tools/base/process.h"
#include "tools/base/standard_streams.h"
#include "tools/base/text.h"
#include "tools/mpi/world.h"
#include "tools/operator_new.h"
#include "tools/program.h"

namespace {

using namespace misfit::tools;
namespace imager = misfit::imager;

/// Prints the reason, and ends the other ranks, too. An error of all ranks is printed by the first: the others give it time.
int fail(const char* message, ExitCode code, const World& world) {
  const imager::Ranks& ranks = world.ranks();
  if (!ranks.first()) std::this_thread::sleep_for(std::chrono::seconds(3));
  const std::string which = ranks.alone() ? "" : "rank " + std::to_string(ranks.rank()) + ": ";
  std::fprintf(stderr, "misfit: %s%s\n", which.c_str(), legible(message).c_str());
  world.end_all(code);
  return code;
}

/// For exceptions that nothing can catch: casacore throws some while it closes tables.
[[noreturn]] void end_at_once() {
  std::string why = "an unknown error";
  try {
    if (std::current_exception()) throw;
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {
  }
  const std::string system = errno == ENOSPC || errno == EDQUOT || errno == EIO ? std::strerror(errno) : "";
  if (why.find(system) == std::string::npos) why += ": " + system;
  std::fprintf(stderr, "misfit: cannot go on: %s\n", legible(why).c_str());
  _exit(unusable_data);
}

constexpr const char* out_of_memory = "out of memory; expected fewer pixels or channels, or more memory";

int run(int argc, char** argv, const World& world) {
  std::string line = "misfit";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  const std::unique_ptr<CLI::App> made = make_program({line, world.ranks()});
  CLI::App& program = *made;
  try {
    program.parse(argc, argv);
    finish_standard_output();
    return done;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      if (world.ranks().first()) program.exit(error);
      finish_standard_output();
      return done;
    }
    return fail(usage_message(error, program).c_str(), wrong_usage, world);
  } catch (const Interrupted& error) {
    return fail(error.what(), stopped_by_user, world);
  } catch (const std::invalid_argument& error) {
    return fail(error.what(), wrong_usage, world);
  } catch (const std::bad_alloc&) {
    return fail(out_of_memory, unusable_data, world);
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) return fail(error.what(), unusable_data, world);
    return fail("the system refuses another thread; expected more memory, or a higher limit of processes (ulimit -u)",
                unusable_data, world);
  } catch (const std::exception& error) {
    return fail(error.what(), unusable_data, world);
  }
}

/// Runs among the processes that share the run; all have left it when this returns.
int run_together(int argc, char** argv) {
  try {
    const World world;
    return run(argc, argv, world);
  } catch (const std::bad_alloc&) {  // the run has not begun, and nobody else reports it
    std::fprintf(stderr, "misfit: %s\n", out_of_memory);
    return unusable_data;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "misfit: %s\n", legible(error.what()).c_str());
    return unusable_data;
  }
}

}  // namespace

/// The number of threads that OpenBLAS starts before main begins. casacore loads OpenBLAS where it is the system's LAPACK; it
/// calls its own function of this name, unless the executable defines one. A run solves nothing by LAPACK, and each such thread
/// asks for memory until it gets it.
extern "C" [[gnu::visibility("default")]] int openblas_num_threads_env() {
  return 1;
}

int main(int argc, char** argv) {
  begin_to_throw_bad_alloc();
  hold_standard_streams();
  std::set_terminate(end_at_once);
  std::cerr.rdbuf(nullptr);  // where casacore tells of failures that it throws, too
  prepare_process();
  end_process(run_together(argc, argv));
}
