#include "tools/base/interrupt.h"

#include <csignal>

namespace misfit::tools {
namespace {

volatile std::sig_atomic_t flag = 0;

void remember(int signal) {
  flag = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  if (interrupted()) return;
  std::signal(SIGINT, remember);
  std::signal(SIGTERM, remember);
}

bool interrupted() {
  return flag != 0;
}

}  // namespace misfit::tools
