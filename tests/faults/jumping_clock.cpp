// Preloaded, it has the system's clock jump by up to ten years, there and back, whenever it is asked.
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>

namespace {

std::atomic<std::uint64_t> state{1};

/// Seconds; a linear congruence, Knuth's.
std::int64_t jump() {
  const std::uint64_t next = state.load() * 6364136223846793005U + 1442695040888963407U;
  state = next;
  constexpr std::int64_t ten_years_s = 315576000;
  return static_cast<std::int64_t>(next >> 33) % (2 * ten_years_s) - ten_years_s;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const int result = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) now->tv_sec += jump();
  return result;
}

int gettimeofday(timeval* now, void*) noexcept {
  timespec exact{};
  const int result = clock_gettime(CLOCK_REALTIME, &exact);
  *now = {exact.tv_sec, exact.tv_nsec / 1000};
  return result;
}

time_t time(time_t* where) noexcept {
  timespec exact{};
  clock_gettime(CLOCK_REALTIME, &exact);
  if (where) *where = exact.tv_sec;
  return exact.tv_sec;
}
}
