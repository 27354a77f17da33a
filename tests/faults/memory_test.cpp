// Runs to which the system refuses memory.
#include <sys/syscall.h>

#include <fstream>
#include <iterator>
#include <map>

#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(memory)

using namespace misfit::tools::testing;
using misfit::testing::memory_calls;

namespace {

/// Memory alone, not what makes a file readable; once the program has begun to work.
bool asks_for_memory(const SystemCall& call) {
  return (call.number != SYS_mmap || call.path().empty()) && std::filesystem::exists(products().path("a.lock"));
}

}  // namespace

/// Small pieces come from what the process has; what it asks of the system are grids, images, and stacks of threads.
BOOST_AUTO_TEST_CASE(a_run_that_gets_no_more_memory_says_so_and_leaves_whole_files) {
  std::size_t all = 0, refused = 0;
  products().restore();
  run_with_faults(products().run(), memory_calls, [&](const SystemCall& call) {
    all += asks_for_memory(call) ? 1 : 0;
    return Answer{};
  });
  BOOST_TEST(all > 40U);
  for (const bool once : {false, true})
    for (std::size_t first = 0; first < all; first += std::max<std::size_t>(1, all / 40)) {
      products().restore();
      std::size_t calls = 0;
      const Outcome outcome = run_with_faults(products().run(), memory_calls, [&](const SystemCall& call) {
        const bool fails = asks_for_memory(call) && calls++ >= first && (!once || calls == first + 1);
        return Answer{fails ? ENOMEM : 0};
      });
      BOOST_TEST_CONTEXT("call " << first << " of " << all << (once ? " alone: " : " and later ones: ") << outcome.err) {
        BOOST_TEST((outcome.code == 1 || outcome.code == 0));
        BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == outcome.code);
        products().expect_whole();
      }
      refused += outcome.code == 1 ? 1 : 0;
    }
  BOOST_TEST(refused > 0U);
  products().expect_set_unharmed();
}

/// OpenBLAS, where it is the system's LAPACK, would have three wait before main begins.
BOOST_AUTO_TEST_CASE(no_thread_begins_that_has_nothing_to_do) {
  std::ifstream maps("/proc/self/maps");  // of these tests, which load the libraries that the program loads
  const std::string loaded{std::istreambuf_iterator<char>(maps), {}};
  if (loaded.find("openblas") == std::string::npos) BOOST_TEST_MESSAGE("skipped: the system's LAPACK is not OpenBLAS's");
  const EnvironmentVariable four("OPENBLAS_NUM_THREADS", "4");
  std::size_t threads = 0;
  const Outcome outcome = run_with_faults({"--version"}, {SYS_clone, SYS_clone3}, [&](const SystemCall&) {
    ++threads;
    return Answer{};
  });
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(threads == 0U);
}

/// Threads that there are do what others would have done. Reading ahead alone cannot go on without one, and says so.
BOOST_AUTO_TEST_CASE(a_run_that_gets_no_more_threads_makes_the_same_images_or_says_so) {
  const TemporaryFolder folder;
  const Arguments image = small_image(snapshot(), folder / "a") + Arguments{"--niter", "20", "--threads", "2", "--quiet"};
  const auto images = [&] {
    std::map<std::string, std::string> fits;
    for (const auto& [name, bytes] : files_below(folder / ""))
      if (ends_with(name, ".fits")) fits[name] = bytes;
    return fits;
  };
  std::size_t all = 0, done = 0;
  const std::vector<long> begins_thread{SYS_clone, SYS_clone3};
  run_with_faults(image, begins_thread, [&](const SystemCall&) {
    ++all;
    return Answer{};
  });
  const auto unhindered = images();
  BOOST_TEST(all > 10U);
  BOOST_TEST(unhindered.size() == 4U);
  for (std::size_t first = 0; first < all; first += std::max<std::size_t>(1, all / 12)) {
    for (const auto& file : unhindered) std::filesystem::remove(file.first);
    std::size_t calls = 0;
    const Outcome outcome =
        run_with_faults(image, begins_thread, [&](const SystemCall&) { return Answer{calls++ >= first ? EAGAIN : 0}; });
    BOOST_TEST_CONTEXT("thread " << first << " of " << all << " and later ones: " << outcome.err) {
      if (outcome.code == 0)
        BOOST_TEST((images() == unhindered));
      else
        BOOST_TEST(outcome.err.find("the system refuses another thread") != std::string::npos);
      BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == outcome.code);
    }
    done += outcome.code == 0 ? 1 : 0;
  }
  BOOST_TEST(done > 0U);
}

/// From what the program cannot begin with to what a run needs. Whatever libraries it came with, it ends: seconds are plenty.
BOOST_AUTO_TEST_CASE(a_process_of_little_memory_says_so_and_leaves_nothing) {
  const TemporaryFolder folder;
  Arguments image = small_image(snapshot(), folder / "a") + Arguments{"--threads", "1", "--quiet"};
  image[6] = "2048";
  std::size_t refused = 0;
  Outcome outcome{1, "", ""};
  for (int mib = 96; outcome.code != 0 && mib < 2000; mib += 16) {
    outcome = Child(Arguments{"--as=" + std::to_string(std::int64_t{mib} << 20), MISFIT_PROGRAM} + image, "prlimit")
                  .wait_at_most(std::chrono::seconds(60));
    constexpr int not_loaded = 127;  // says the loader of a program whose libraries found no room
    BOOST_TEST((outcome.code == 0 || outcome.code == 1 || outcome.code == not_loaded), mib << " MiB: code " << outcome.code);
    if (outcome.code != 1) continue;
    BOOST_TEST_CONTEXT(mib << " MiB: " << outcome.err) {
      BOOST_TEST(outcome.err.find("memory") != std::string::npos);
      BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
      for (const auto& file : files_below(folder / "")) BOOST_TEST(!ends_with(file.first, ".part"));
    }
    ++refused;
  }
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(refused > 3U);
}

BOOST_AUTO_TEST_SUITE_END()
