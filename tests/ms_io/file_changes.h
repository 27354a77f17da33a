#pragma once

#include <fcntl.h>
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

/// Whether a system call changes a file.
inline bool changes_file(const __ptrace_syscall_info& call) {
  static const std::set<std::uint64_t> always{
#ifdef SYS_rename
      SYS_rename,   SYS_unlink,    SYS_rmdir,    SYS_mkdir,   SYS_link,     SYS_symlink,
#endif
      SYS_renameat, SYS_renameat2, SYS_unlinkat, SYS_mkdirat, SYS_linkat,   SYS_symlinkat,
      SYS_write,    SYS_writev,    SYS_pwrite64, SYS_pwritev, SYS_truncate, SYS_ftruncate};
  if (call.entry.nr == SYS_openat) return (call.entry.args[2] & (O_CREAT | O_TRUNC)) != 0;
  return always.count(call.entry.nr) > 0;
}

/// Runs `action` in a process of its own, and calls `look` before every single change of a file there: what `look` finds on
/// disk is what would be left, were the process killed at that moment. Returns whether the action came to its end.
inline bool before_each_change(const std::function<void()>& action, const std::function<void()>& look) {
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
  int status = 0;
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
    if (!call || ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0) continue;
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY && changes_file(info)) look();
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace misfit::testing
