#include "tools/base/interrupt.h"

#include <atomic>
#include <csignal>
#include <mutex>

namespace misfit::tools {
namespace {

std::atomic<bool> flag = false, again = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");
std::atomic<bool> borrowed = false;
struct sigaction process_own;
bool is_caught = false;

void remember(int signal) {
  flag = true;
  std::signal(signal, SIG_DFL);
}

void remember_each(int /*signal*/) {
  again = flag.exchange(true) || again;
}

}  // namespace

void catch_interrupts() {
  if (borrowed) return;
  static std::once_flag once;
  std::call_once(once, [] {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  });
}

bool interrupted() {
  return flag;
}

bool interrupted_again() {
  return again;
}

BorrowedProcess::BorrowedProcess(bool catches_interrupts) {
  borrowed = true;
  flag = again = false;
  is_caught = catches_interrupts;
  struct sigaction ours = {};
  ours.sa_handler = remember_each;
  ours.sa_flags = SA_RESTART;
  if (is_caught) sigaction(SIGINT, &ours, &process_own);
  if (is_caught && process_own.sa_handler == SIG_IGN) {  // as nohup and shells set it
    sigaction(SIGINT, &process_own, nullptr);
    is_caught = false;
  }
}

BorrowedProcess::~BorrowedProcess() {
  if (is_caught) sigaction(SIGINT, &process_own, nullptr);
  flag = again = borrowed = false;
}

}  // namespace misfit::tools
