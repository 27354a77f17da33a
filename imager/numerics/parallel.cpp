#include "imager/numerics/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace misfit::imager {
namespace {

thread_local StopCheck* stop_check = nullptr;

}  // namespace

StopCheck::StopCheck(std::function<void()> check)
    : check_(std::move(check)), last_(std::chrono::steady_clock::now()), outer_(stop_check) {
  stop_check = this;
}

StopCheck::~StopCheck() {
  stop_check = outer_;
}

void StopCheck::now_and_then() {
  if (stop_check == nullptr) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - stop_check->last_ < std::chrono::milliseconds(20)) return;
  stop_check->last_ = now;
  stop_check->check_();
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        StopCheck::now_and_then();
        body(i);
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  const std::size_t workers = std::min(static_cast<std::size_t>(std::max(threads, 1)), count);
  try {
    for (std::size_t i = 1; i < workers; ++i) others.emplace_back(work);
  } catch (const std::system_error&) {  // no more threads are to be had: those there are do it all
  }
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

void parallel_in_order(std::size_t count, int threads, const std::function<void(std::size_t)>& body,
                       const std::function<void(std::size_t)>& take) {
  const std::size_t ahead = 2 * static_cast<std::size_t>(std::max(threads, 1));
  std::mutex mutex;  // of what follows
  std::condition_variable taken;
  std::vector<bool> done(count);
  std::size_t next = 0;
  bool failed = false;
  parallel_for(count, threads, [&](std::size_t i) {
    try {
      {
        std::unique_lock lock(mutex);
        taken.wait(lock, [&] { return i < next + ahead || failed; });
        if (failed) return;
      }
      body(i);
      const std::lock_guard lock(mutex);
      done[i] = true;
      while (!failed && next < count && done[next]) take(next++);
    } catch (...) {
      const std::lock_guard lock(mutex);
      failed = true;
      taken.notify_all();
      throw;
    }
    taken.notify_all();
  });
}

int available_threads(int processes) {
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  cpu_set_t mine;
  const int own = sched_getaffinity(0, sizeof mine, &mine) == 0 ? CPU_COUNT(&mine) : all;
  return std::max(1, own / processes);
}

}  // namespace misfit::imager
