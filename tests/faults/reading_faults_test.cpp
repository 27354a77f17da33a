// Runs whose MeasurementSet cannot be read to its end.
#include <sys/syscall.h>

#include <cstring>

#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(reading_faults)

using namespace misfit::tools::testing;
using misfit::testing::reading_calls;

namespace {

/// Lock files apart, which are looked at before casacore does: it crashes where it cannot read one.
bool reads_set(const SystemCall& call) {
  const std::string path = call.path();
  return path.rfind(snapshot(), 0) == 0 && !ends_with(path, "table.lock");
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_set_that_cannot_be_read_is_named_and_leaves_whole_files, *boost::unit_test::label("sweep")) {
  std::size_t all = 1;
  for (const int half : {0, 1})
    for (std::size_t first = 0; first < all; first += std::max<std::size_t>(1, all / 60)) {
      products().restore();
      std::size_t calls = 0;
      std::string failed;
      const Outcome outcome = run_with_faults(products().run(), reading_calls, [&](const SystemCall& call) {
        if (!reads_set(call) || calls++ < first) return Answer{};
        if (failed.empty()) failed = call.path();
        return half == 1 && calls == first + 1 ? Answer{0, true} : Answer{EIO};
      });
      if (first == 0) all = std::max<std::size_t>(calls, 400);
      if (failed.empty()) break;
      BOOST_TEST_CONTEXT("read " << first << ", of " << failed << ": " << outcome.err) {
        BOOST_TEST(outcome.code == 1);
        BOOST_TEST(outcome.err.find(snapshot()) != std::string::npos);
        BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        products().expect_whole();
      }
    }
  products().expect_set_unharmed();
}

BOOST_AUTO_TEST_CASE(a_lock_file_that_cannot_be_read_is_named) {
  products().restore();
  std::string failed;
  const Outcome outcome = run_with_faults(products().run(), reading_calls, [&](const SystemCall& call) {
    const std::string path = call.path();
    if (!ends_with(path, "FIELD/table.lock")) return Answer{};
    failed = path;
    return Answer{EIO};
  });
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err == "misfit: cannot read " + failed + ": " + std::strerror(EIO) + "\n");
  products().expect_whole();
}

BOOST_AUTO_TEST_CASE(a_lock_file_of_impossible_numbers_is_named) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", lock = set + "/ANTENNA/table.lock";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  const std::string whole = content(lock);
  for (const std::size_t at : {0U, 260U})
    for (const char* bytes : {"\x7f\xff\xff\xff", "\xff\xff\xff\xff", "\x80\x01\x02\x03"}) {
      std::string damaged = whole;
      damaged.replace(at, 4, bytes, 4);
      std::ofstream(lock, std::ios::binary) << damaged;
      const Outcome outcome = run(small_image(set, folder / "a"));
      BOOST_TEST(outcome.code == 1);
      BOOST_TEST(outcome.err.rfind("misfit: cannot read " + lock + ": it states", 0) == 0U, outcome.err);
    }
  std::ofstream(lock, std::ios::binary) << whole.substr(0, 100);  // a short one is a new one
  succeed(small_image(set, folder / "a"));
}

BOOST_AUTO_TEST_SUITE_END()
