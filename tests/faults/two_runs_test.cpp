// Runs of one imagename at the same time.
#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(two_runs)

using namespace misfit::tools::testing;

BOOST_AUTO_TEST_CASE(a_second_run_of_a_name_is_refused_and_harms_nothing) {
  const TemporaryFolder folder;
  const Arguments image = small_image(snapshot(), folder / "a");
  Child first(image + Arguments{"--niter", "1000000", "--gain", "0.001", "--cycleniter", "5", "--quiet"});
  first.wait_until([&] { return std::filesystem::exists(folder / "a.clean.state"); });
  for (const Arguments& kind : {Arguments{}, {"--specmode", "cube", "--outframe", "TOPO"}}) {
    const Outcome second = run(image + kind);
    BOOST_TEST(second.code == 1);
    BOOST_TEST(second.err.find("another run is making " + (folder / "a") + ".*, process ") != std::string::npos, second.err);
    BOOST_TEST(second.err.find("expected another --imagename") != std::string::npos, second.err);
    BOOST_TEST(std::filesystem::exists(folder / "a.lock"));
  }
  BOOST_TEST(run(image + Arguments{"--dry-run"}).code == 0);
  succeed(small_image(snapshot(), folder / "ab"));
  first.signal(SIGTERM);
  BOOST_TEST(first.wait().code == 130);
  BOOST_TEST(!std::filesystem::exists(folder / "a.lock"));
  BOOST_TEST(pixels_of(folder / "a", "image").pixel.size() == 64U * 64);
}

BOOST_AUTO_TEST_CASE(a_name_is_free_again_when_its_run_was_killed) {
  const TemporaryFolder folder;
  const Arguments image = small_image(snapshot(), folder / "a");
  Child first(image + Arguments{"--niter", "1000000", "--gain", "0.001", "--cycleniter", "5", "--quiet"});
  first.wait_until([&] { return std::filesystem::exists(folder / "a.clean.state"); });
  first.signal(SIGKILL);
  BOOST_TEST(first.wait().code == -SIGKILL);
  BOOST_TEST(std::filesystem::exists(folder / "a.lock"));
  succeed(image);
  BOOST_TEST(!std::filesystem::exists(folder / "a.lock"));
}

BOOST_AUTO_TEST_SUITE_END()
