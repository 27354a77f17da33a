#include "tests/faults/traced_process.h"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/limits.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <set>
#include <stdexcept>

namespace misfit::testing {

const std::vector<long> changing_calls{SYS_rename,    SYS_renameat, SYS_renameat2, SYS_unlink,  SYS_unlinkat, SYS_rmdir,
                                       SYS_mkdir,     SYS_mkdirat,  SYS_link,      SYS_linkat,  SYS_symlink,  SYS_symlinkat,
                                       SYS_write,     SYS_writev,   SYS_pwrite64,  SYS_pwritev, SYS_truncate, SYS_ftruncate,
                                       SYS_fallocate, SYS_fsync,    SYS_fdatasync, SYS_openat,  SYS_open,     SYS_creat};
const std::vector<long> reading_calls{SYS_read, SYS_pread64, SYS_readv, SYS_preadv};
const std::vector<long> memory_calls{SYS_mmap, SYS_mremap};

namespace {

bool is_one_of(long number, std::initializer_list<long> numbers) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

/// A string in the memory of another process.
std::string text_at(pid_t thread, std::uint64_t address) {
  std::string text;
  for (char page[256];;) {  // no further than the page ends: the next may not be there
    const std::size_t bytes = sizeof page - address % sizeof page;
    const iovec here{page, bytes}, there{reinterpret_cast<void*>(address), bytes};
    const ssize_t got = process_vm_readv(thread, &here, 1, &there, 1, 0);
    if (got <= 0) return text;
    const char* end = static_cast<const char*>(std::memchr(page, 0, static_cast<std::size_t>(got)));
    text.append(page, end ? static_cast<std::size_t>(end - page) : static_cast<std::size_t>(got));
    if (end) return text;
    address += static_cast<std::uint64_t>(got);
  }
}

std::string link_target(const std::string& link) {
  char target[PATH_MAX];
  const ssize_t size = readlink(link.c_str(), target, sizeof target);
  return size < 0 ? "" : std::string(target, static_cast<std::size_t>(size));
}

/// Lets the kernel stop at these calls alone, so that all others cost nothing.
void stop_at(const std::vector<long>& calls) {
  std::vector<sock_filter> program{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const long number : calls) {
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(number), 0, 1));
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) _exit(126);
}

/// Of a call whose bytes lie in several parts.
void halve_last_part(pid_t thread, const SystemCall& call) {
  std::vector<iovec> part(call.argument[2]);
  const iovec here{part.data(), part.size() * sizeof(iovec)};
  const iovec there{reinterpret_cast<void*>(call.argument[1]), here.iov_len};
  if (process_vm_readv(thread, &here, 1, &there, 1, 0) < 0) return;
  const auto last = std::find_if(part.rbegin(), part.rend(), [](const iovec& some) { return some.iov_len > 1; });
  if (last != part.rend()) last->iov_len /= 2;
  process_vm_writev(thread, &here, 1, &there, 1, 0);
}

void obey(pid_t thread, const SystemCall& call, const Answer& answer) {
  if (answer.signal != 0) kill(thread, answer.signal);
  if (answer.half && is_one_of(call.number, {SYS_writev, SYS_readv})) return halve_last_part(thread, call);
  if (answer.error == 0 && !answer.half) return;
  user_regs_struct registers{};
  ptrace(PTRACE_GETREGS, thread, nullptr, &registers);
  if (answer.error != 0) {
    registers.orig_rax = ~0ULL;  // no call at all
    registers.rax = static_cast<unsigned long long>(-answer.error);
  } else {
    registers.rdx = std::max<std::uint64_t>(1, call.argument[2] / 2);
  }
  ptrace(PTRACE_SETREGS, thread, nullptr, &registers);
}

}  // namespace

std::string SystemCall::path() const {
  const auto of = [&](std::uint64_t descriptor) {
    return link_target("/proc/" + std::to_string(thread_) + "/fd/" + std::to_string(static_cast<int>(descriptor)));
  };
  if (is_one_of(number, {SYS_openat, SYS_mkdirat, SYS_unlinkat, SYS_renameat, SYS_renameat2, SYS_linkat}))
    return text_at(thread_, argument[1]);
  if (is_one_of(number,
                {SYS_open, SYS_creat, SYS_rename, SYS_unlink, SYS_rmdir, SYS_mkdir, SYS_link, SYS_symlink, SYS_truncate}))
    return text_at(thread_, argument[0]);
  if (number == SYS_symlinkat) return text_at(thread_, argument[0]);
  if (number == SYS_mmap) return (argument[3] & MAP_ANONYMOUS) != 0 ? "" : of(argument[4]);
  return number == SYS_mremap ? "" : of(argument[0]);
}

bool SystemCall::changes_file() const {
  if (number == SYS_openat) return (argument[2] & (O_CREAT | O_TRUNC)) != 0;
  if (number == SYS_open) return (argument[1] & (O_CREAT | O_TRUNC)) != 0;
  return std::find(changing_calls.begin(), changing_calls.end(), number) != changing_calls.end();
}

int trace(const std::function<void()>& action, const std::vector<long>& calls,
          const std::function<Answer(const SystemCall&)>& answer) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
    stop_at(calls);
    try {
      action();
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  constexpr long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                           PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
  if (ptrace(PTRACE_SETOPTIONS, child, nullptr, options) != 0 || ptrace(PTRACE_CONT, child, nullptr, 0) != 0) {
    const std::string why = std::strerror(errno);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    throw std::runtime_error("a process may not be traced here: " + why);
  }
  std::set<pid_t> known{child};
  int ended = -SIGKILL;
  for (pid_t thread; (thread = waitpid(-1, &status, __WALL)) > 0;) {
    if (WIFEXITED(status) || WIFSIGNALED(status)) {
      known.erase(thread);
      if (thread == child) ended = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      continue;
    }
    const bool is_new = known.insert(thread).second;
    int signal = WSTOPSIG(status);
    if (status >> 16 == PTRACE_EVENT_SECCOMP) {
      __ptrace_syscall_info info{};
      if (ptrace(PTRACE_GET_SYSCALL_INFO, thread, sizeof info, &info) > 0) {
        std::array<std::uint64_t, 6> argument{};
        std::copy(std::begin(info.seccomp.args), std::end(info.seccomp.args), argument.begin());
        const SystemCall call(thread, static_cast<long>(info.seccomp.nr), argument);
        obey(thread, call, answer(call));
      }
      signal = 0;
    } else if (status >> 16 != 0 || (is_new && signal == SIGSTOP)) {
      signal = 0;  // it has begun, or begun another program
    }
    ptrace(PTRACE_CONT, thread, nullptr, signal);
  }
  return ended;
}

}  // namespace misfit::testing
