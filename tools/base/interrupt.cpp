#include "tools/base/interrupt.h"

#include <atomic>
#include <csignal>
#include <mutex>

namespace misfit::tools {
namespace {

std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

void remember(int signal) {
  flag = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  static std::once_flag once;
  std::call_once(once, [] {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  });
}

bool interrupted() {
  return flag;
}

}  // namespace misfit::tools
