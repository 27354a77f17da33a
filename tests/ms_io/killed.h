#pragma once

#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>

namespace misfit::testing {

/// Runs `action` in a process of its own, which is killed before it changes a file for the `changes`-th time since it first
/// renamed one: always at the same place. Returns whether it was killed; false where it came to its end before.
inline bool killed_before_change(int changes, const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
    try {
      action();
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  std::set<std::uint64_t> renames{SYS_renameat, SYS_renameat2}, others{SYS_write, SYS_pwrite64, SYS_ftruncate};
#ifdef SYS_rename
  renames.insert(SYS_rename);
#endif
  int status = 0, seen = -1;
  waitpid(child, &status, WUNTRACED);
  if (ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL) != 0) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    throw std::runtime_error("a process may not be traced here: " + std::string(std::strerror(errno)));
  }
  for (int signal = 0; ptrace(PTRACE_SYSCALL, child, nullptr, signal) == 0 && waitpid(child, &status, 0) == child;) {
    if (WIFEXITED(status) || WIFSIGNALED(status)) break;
    const bool call = WSTOPSIG(status) == (SIGTRAP | 0x80);
    signal = call ? 0 : WSTOPSIG(status);
    __ptrace_syscall_info info{};
    if (!call || ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0 || info.op != PTRACE_SYSCALL_INFO_ENTRY)
      continue;
    const bool renames_file = renames.count(info.entry.nr) > 0;
    if (!renames_file && (seen < 0 || others.count(info.entry.nr) == 0)) continue;
    if (++seen < changes) continue;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  return WIFSIGNALED(status);
}

}  // namespace misfit::testing
