#include "tools/base/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "tools/base/interrupt.h"

namespace misfit::tools {

namespace {

/// Waits until the process has ended, or the user asks to stop.
void watch(pid_t process) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
  if (handle < 0) return;
  constexpr int often_ms = 100;  // a signal between question and wait wakes nobody
  pollfd watched{handle, POLLIN, 0};
  while (!interrupted() && poll(&watched, 1, often_ms) <= 0) {
  }
  close(handle);
}

}  // namespace

std::optional<int> run_program(std::vector<std::string> words, const std::filesystem::path& folder, OnInterrupt on_interrupt) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "said", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return std::nullopt;
  if (on_interrupt == OnInterrupt::stop) watch(process);
  if (on_interrupt == OnInterrupt::stop && interrupted()) kill(process, SIGTERM);
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace misfit::tools
