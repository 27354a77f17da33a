#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <thread>

namespace misfit::python {

/// How long Ctrl-C may wait.
inline constexpr std::chrono::milliseconds patience(50);

/// Calls of interruptibly() whose work goes on.
inline std::atomic<int> at_work{0};

/// Called as the process ends, with its status. It ends the process at once where work goes on unseen, which must not meet
/// objects that are destroyed.
inline void end_at_once(int status, void* /*nothing*/) {
  if (at_work == 0) return;
  std::fflush(nullptr);
  _exit(status);
}

/// Returns or throws what `work` does, called on a thread of its own while other Python threads run. Ctrl-C raises its Python
/// exception (pybind11::error_already_set) soon; `work` then goes on unseen until it ends or the
/// process does, so it must own what it uses and keep away from Python.
template <typename Result>
Result interruptibly(std::function<Result()> work) {
  std::packaged_task<Result()> task(std::move(work));
  std::future<Result> result = task.get_future();
  ++at_work;
  std::thread([task = std::move(task)]() mutable {
    task();
    --at_work;
  }).detach();
  while (true) {
    {
      const pybind11::gil_scoped_release others_run;
      if (result.wait_for(patience) == std::future_status::ready) return result.get();
    }
    if (PyErr_CheckSignals() != 0) {
      on_exit(end_at_once, nullptr);  // now, so that it comes before destructors of what the work has made
      throw pybind11::error_already_set();
    }
  }
}

/// Calls `work(begin, end)` for one block of [0, size) after the other while other Python threads run. Ctrl-C raises its Python
/// exception between two.
template <typename Work>
void in_blocks(pybind11::ssize_t size, pybind11::ssize_t block, const Work& work) {
  const pybind11::gil_scoped_release others_run;
  auto last = std::chrono::steady_clock::now();
  for (pybind11::ssize_t begin = 0; begin < size; begin += block) {
    work(begin, std::min(begin + block, size));
    if (std::chrono::steady_clock::now() - last < patience) continue;
    const pybind11::gil_scoped_acquire alone;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    last = std::chrono::steady_clock::now();
  }
}

}  // namespace misfit::python
