// What a run leaves that is asked to end, or killed, at every place where it changes a file.
#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(signals)

using namespace misfit::tools::testing;
using misfit::testing::changing_calls;

BOOST_AUTO_TEST_CASE(a_run_that_is_killed_leaves_whole_files) {
  products().restore();
  std::size_t looked = 0;
  const Outcome outcome = run_with_faults(products().run(), changing_calls, [&](const SystemCall& call) {
    if (call.changes_file() && products().concerns(call))
      BOOST_TEST_CONTEXT("before change " << ++looked << ", of " << call.path()) {
        products().expect_whole(true);
      }
    return Answer{};
  });
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(looked > 30U);
  products().expect_set_unharmed();
}

BOOST_AUTO_TEST_CASE(the_next_run_removes_what_a_killed_one_was_writing) {
  products().restore();
  std::size_t writes = 0;
  run_with_faults(products().run(), changing_calls, [&](const SystemCall& call) {
    const bool half_written = call.path().find(".psf.fits.") != std::string::npos && ++writes == 3;
    return Answer{.signal = half_written ? SIGKILL : 0};
  });
  const auto left = [] {
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator(products().path("")))
      files += file.path().extension() == ".part" || file.path().extension() == ".lock" ? 1 : 0;
    return files;
  };
  BOOST_TEST(left() == 4U + 1);                                // images, begun together, and the lock
  const std::string others = products().path("a.notes.part");  // a name that no run gives
  std::ofstream(others) << "of the user";
  BOOST_TEST(run(products().run()).code == 0);
  BOOST_TEST(left() == 1U);
  BOOST_TEST(content(others) == "of the user");
}

/// The first one asks for an end that leaves images; while they are being written, they are finished.
BOOST_AUTO_TEST_CASE(a_run_that_is_told_to_end_leaves_whole_files) {
  for (const int signal : {SIGINT, SIGTERM})
    for (std::size_t at = 0, calls = 1; at < calls; at += 3 * stride) {
      products().restore();
      calls = 0;
      const Outcome outcome = run_with_faults(products().run(), changing_calls, [&](const SystemCall& call) {
        const bool now = call.changes_file() && products().concerns(call) && calls++ == at;
        return Answer{.signal = now ? signal : 0};
      });
      BOOST_TEST_CONTEXT("signal " << signal << " before change " << at << ": " << outcome.err) {
        BOOST_TEST((outcome.code == 130 || outcome.code == 0));
        products().expect_whole(false, true);
      }
    }
  products().expect_set_unharmed();
}

BOOST_AUTO_TEST_SUITE_END()
