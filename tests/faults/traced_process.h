#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace misfit::testing {

/// A call that a thread is about to make of the system.
class SystemCall {
 public:
  SystemCall(pid_t by, long which, const std::array<std::uint64_t, 6>& with) : number(which), argument(with), thread_(by) {}

  /// The file that it is about: what its descriptor stands for, or the first path it names; empty where it is about none.
  std::string path() const;
  /// Whether it can change what lies on a disk.
  bool changes_file() const;

  long number;  ///< SYS_…
  std::array<std::uint64_t, 6> argument;

 private:
  pid_t thread_;
};

/// What becomes of a call.
struct Answer {
  int error = 0;      ///< the errno that it fails with, in place of being made; 0 lets it be made
  bool half = false;  ///< whether it reads or writes half of the bytes
  int signal = 0;     ///< sent to the process at that moment
};

/// Calls that change files or open them, that read them, and that ask for memory.
extern const std::vector<long> changing_calls, reading_calls, memory_calls;

/// Runs `action` in a process of its own, which shall not return or ends with code 0, and asks `answer` what becomes of each of
/// the `calls` that any thread of it or any process that it starts makes: what `answer` finds on disk is what would be left,
/// were the process killed at that moment. Returns its exit code, or minus the signal that ended it. Throws std::runtime_error
/// where processes may not be traced.
int trace(const std::function<void()>& action, const std::vector<long>& calls,
          const std::function<Answer(const SystemCall&)>& answer);

}  // namespace misfit::testing
