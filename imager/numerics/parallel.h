#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

namespace misfit::imager {

/// Runs body(i) for i = 0 … count − 1, shared among `threads` threads, each taking the next i when it is free. Returns when all
/// are done; the first exception that a body throws is rethrown, and no further i is begun.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t i)>& body);

/// Runs body(i) as parallel_for does, and take(i) for each i once its body is done, in the order of i and one at a time. No
/// body begins for an i more than 2 · `threads` ahead of the last one taken.
void parallel_in_order(std::size_t count, int threads, const std::function<void(std::size_t i)>& body,
                       const std::function<void(std::size_t i)>& take);

/// While it lives, loops of parallel_for that its own thread runs call `check` now and then, on that thread; an exception of
/// the check ends the loop as a body's exception does.
class StopCheck {
 public:
  explicit StopCheck(std::function<void()> check);
  ~StopCheck();
  StopCheck(const StopCheck&) = delete;
  StopCheck& operator=(const StopCheck&) = delete;

  /// Calls the check of the current thread, if there is one and its last call was 20 ms ago.
  static void now_and_then();

 private:
  std::function<void()> check_;
  std::chrono::steady_clock::time_point last_;
  StopCheck* outer_;  ///< that this one replaces while it lives
};

/// The number of threads that `--threads 0` means: all cores that this process may use, or its share of them where `processes`
/// use them.
int available_threads(int processes = 1);

}  // namespace misfit::imager
