#pragma once

#include <stdexcept>

namespace misfit::tools {

/// Thrown where work ends because the user pressed Ctrl-C, closed the terminal, or asked the process to terminate.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("stopped by the user") {}
};

/// From here on the first SIGINT, SIGTERM or SIGHUP only sets a flag, unless nohup or a shell has it ignored; a second ends
/// the process at once, whoever calls this again.
void catch_interrupts();
bool interrupted();
/// True if the user pressed Ctrl-C twice in another program's process: stages that stop by themselves then end at once, too.
bool interrupted_again();

/// As long as it lives, work is done in another program's process, such as Python's. catch_interrupts() does nothing then.
/// SIGINT is caught, if asked, unless the process ignores it, and is the process's own again afterwards. One may live at a
/// time.
class BorrowedProcess {
 public:
  explicit BorrowedProcess(bool catches_interrupts);
  BorrowedProcess(const BorrowedProcess&) = delete;
  BorrowedProcess& operator=(const BorrowedProcess&) = delete;
  ~BorrowedProcess();
};

}  // namespace misfit::tools
