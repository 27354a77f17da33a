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

}  // namespace misfit::tools
