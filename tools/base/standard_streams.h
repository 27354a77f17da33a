#pragma once

namespace misfit::tools {

/// Opens those of stdin, stdout and stderr that whoever started the program closed, as nothing: else files that it opens get
/// their numbers, and messages are written into them. Lets a pipe that nobody reads any more be a failed write, not the end of
/// a run.
void hold_standard_streams();

/// Throws std::runtime_error where what was printed could not be written; a pipe may be read in part.
void finish_standard_output();

/// Writes what streams still hold and ends the process, without the destructors of static objects: those of libraries may wait
/// for threads that never end. A leak sanitizer looks for leaks first, and changes the code where it finds one.
[[noreturn]] void end_process(int exit_code);

}  // namespace misfit::tools
