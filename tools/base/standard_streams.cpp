#include "tools/base/standard_streams.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>

extern "C" [[gnu::weak]] void __lsan_do_leak_check();  // sanitized programs define it

namespace misfit::tools {

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDWR));  // gets the lowest number that is free
  std::signal(SIGPIPE, SIG_IGN);
}

void finish_standard_output() {
  errno = 0;
  const bool written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  const std::string reason = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
  struct stat found = {};
  const bool pipe = fstat(STDOUT_FILENO, &found) == 0 && (S_ISFIFO(found.st_mode) || S_ISSOCK(found.st_mode));
  if (!written && !pipe) throw std::runtime_error("cannot write to standard output" + reason);
}

void end_process(int exit_code) {
  std::cout.flush();
  std::fflush(nullptr);
  if (__lsan_do_leak_check != nullptr) __lsan_do_leak_check();
  _exit(exit_code);
}

}  // namespace misfit::tools
