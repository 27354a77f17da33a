#pragma once

namespace misfit::tools {

/// Opens /dev/null in place of each of stdin, stdout and stderr that is closed: files that the program opens would get their
/// numbers, and messages would be written into them. Ignores SIGPIPE, so that a pipe without a reader is a failed write and not
/// the end of a run.
void hold_standard_streams();

/// Throws std::runtime_error where what was printed could not be written; a pipe may be read in part.
void finish_standard_output();

/// Writes what streams still hold and ends the process, without the destructors of static objects: those of libraries may wait
/// for threads that never end. A leak sanitizer looks for leaks first, and changes the exit code where it finds one.
[[noreturn]] void end_process(int exit_code);

}  // namespace misfit::tools
