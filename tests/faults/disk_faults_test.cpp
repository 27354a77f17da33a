// What a run leaves when its disk fails it, at every single place where it changes a file.
#include <sys/syscall.h>

#include <cstring>

#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(disk_faults)

namespace {

using namespace misfit::tools::testing;
using misfit::testing::changing_calls;

/// Of a file that may not be complete yet.
std::string final_name(const std::string& path) {
  return std::regex_replace(path, std::regex(R"(\.[0-9a-f]{16}\.part$)"), "");
}

bool writes(const SystemCall& call) {
  return call.number == SYS_write || call.number == SYS_writev || call.number == SYS_pwrite64;
}

bool takes_room(const SystemCall& call) {
  return writes(call) || call.number == SYS_mkdir || (call.number == SYS_openat && call.changes_file());
}

/// Who holds a lock is told in it as a courtesy, and no more.
bool is_courtesy(const SystemCall& call) {
  return call.number != SYS_openat && call.path() == products().path("a.lock");
}

/// Runs once for each of the calls that `picked` picks: from that one on, `fault` says what becomes of them.
void fail_each(const std::function<bool(const SystemCall&)>& picked, const std::function<Answer(std::size_t)>& fault,
               int error) {
  for (std::size_t first = 0;; first += stride) {
    products().restore();
    std::size_t calls = 0;
    std::string failed;
    const Outcome outcome = run_with_faults(products().run(), changing_calls, [&](const SystemCall& call) {
      if (!picked(call) || !products().concerns(call) || is_courtesy(call) || calls++ < first) return Answer{};
      if (failed.empty()) failed = call.path();
      return fault(calls - 1 - first);
    });
    if (calls <= first) {
      BOOST_TEST(first > 10U);
      BOOST_TEST(outcome.code == 0);
      break;
    }
    BOOST_TEST_CONTEXT("call " << first << ", of " << failed << ": " << outcome.err) {
      BOOST_TEST(outcome.code == 1);
      BOOST_TEST(outcome.err.find(std::strerror(error)) != std::string::npos);
      BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
      BOOST_TEST(outcome.err.find(final_name(failed)) != std::string::npos);
      products().expect_whole();
    }
  }
  products().expect_set_unharmed();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_full_disk_is_told_of_and_leaves_whole_files) {
  fail_each(
      takes_room, [](std::size_t) { return Answer{ENOSPC}; }, ENOSPC);
}

BOOST_AUTO_TEST_CASE(a_write_that_fails_half_way_leaves_whole_files) {
  fail_each(
      writes,
      [](std::size_t later) {
        return later == 0 ? Answer{0, true} : Answer{ENOSPC};
      },
      ENOSPC);
}

BOOST_AUTO_TEST_CASE(a_disk_that_fails_is_told_of_and_leaves_whole_files) {
  const auto picked = [](const SystemCall& call) { return call.changes_file() && call.number != SYS_unlink; };
  fail_each(
      picked, [](std::size_t) { return Answer{EIO}; }, EIO);
}

BOOST_AUTO_TEST_SUITE_END()
