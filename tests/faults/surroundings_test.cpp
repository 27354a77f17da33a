// Runs in surroundings that differ from those of a terminal at home.
#include <sys/syscall.h>

#include <cmath>

#include "tests/faults/replaced_products.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(surroundings)

using namespace misfit::tools::testing;
using misfit::testing::changing_calls, misfit::testing::reading_calls;

namespace {

namespace fs = std::filesystem;

/// The program, started by a line of a shell in which `"$0" "$@"` stands for it.
Outcome run_by_shell(const std::string& line, const Arguments& arguments) {
  return Child(Arguments{"-c", line, MISFIT_PROGRAM} + arguments, "sh").wait();
}

/// A run that says what it does.
Arguments talking_run() {
  Arguments arguments = products().run();
  arguments.pop_back();  // --quiet
  return arguments;
}

/// What that leaves where nothing is wrong.
const Files& told() {
  static const Files files = [] {
    products().restore();
    BOOST_REQUIRE_EQUAL(run(talking_run()).code, 0);
    return products().files();
  }();
  return files;
}

/// A run, started by a line of a shell, that leaves that.
Outcome run_as_usual(const std::string& line) {
  const Files& usual = told();
  products().restore();
  Outcome outcome = run_by_shell(line, talking_run());
  products().expect(usual);
  return outcome;
}

/// Runs until the first state of CLEAN is there, and then on.
void hang_up(Child& run, const TemporaryFolder& folder) {
  run.wait_until([&] { return fs::exists(folder / "a.clean.state"); });
  run.signal(SIGHUP);
}

}  // namespace

BOOST_AUTO_TEST_CASE(closed_streams_change_nothing) {
  for (const char* closed : {">&-", "2>&-", "<&-", "<&- >&- 2>&-"})
    BOOST_TEST(run_as_usual(std::string("exec \"$0\" \"$@\" ") + closed).code == 0, closed);
}

/// What is said must not be written into a table that got the number of a stream.
BOOST_AUTO_TEST_CASE(closed_streams_harm_no_column) {
  const TemporaryFolder folder;
  std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,1\n";
  const auto predicted = [&](const std::string& name, const std::string& closed) {
    fs::copy(snapshot(), folder / name, fs::copy_options::recursive);
    const Arguments predict{"predict", "--vis", folder / name, "--components", folder / "sky.csv"};
    const Outcome outcome = run_by_shell("exec \"$0\" \"$@\" " + closed, predict);
    BOOST_TEST(outcome.code == 0, outcome.err);
    auto files = files_below(folder / name);
    std::map<std::string, std::string> bytes;
    for (const auto& [path, content] : files)
      if (!ends_with(path, "table.lock")) bytes[path.substr((folder / name).size())] = content;
    return bytes;
  };
  const auto expected = predicted("open.ms", ""), closed = predicted("closed.ms", "<&- >&- 2>&-");
  BOOST_TEST(expected.size() == closed.size());
  for (const auto& [path, bytes] : expected) BOOST_TEST((closed.count(path) == 1 && closed.at(path) == bytes), path);
}

BOOST_AUTO_TEST_CASE(a_pipe_that_nobody_reads_ends_no_run) {
  run_as_usual("\"$0\" \"$@\" 2>&1 | true");
}

BOOST_AUTO_TEST_CASE(output_that_cannot_be_written_is_told_of) {
  BOOST_TEST(run_as_usual("exec \"$0\" \"$@\" 2>/dev/full").code == 0);
  BOOST_TEST(run_as_usual("exec \"$0\" \"$@\" >/dev/full").code == 1);
  const Outcome help = run_by_shell("exec \"$0\" \"$@\" >/dev/full", {"--help"});
  BOOST_TEST(help.code == 1);
  BOOST_TEST(help.err == "misfit: cannot write to standard output: No space left on device\n");
}

BOOST_AUTO_TEST_CASE(without_a_terminal_all_is_the_same) {
  const Outcome outcome = run_as_usual("unset TERM; exec setsid -w \"$0\" \"$@\" </dev/null");
  BOOST_TEST(outcome.code == 0, outcome.err);
  BOOST_TEST(outcome.err.find('\033') == std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_terminal_that_is_closed_ends_a_run_as_ctrl_c_does) {
  const TemporaryFolder folder;
  Child first(small_image(snapshot(), folder / "a") +
              Arguments{"--niter", "1000000", "--gain", "0.001", "--cycleniter", "5", "--quiet"});
  hang_up(first, folder);
  BOOST_TEST(first.wait().code == 130);
  BOOST_TEST(pixels_of(folder / "a", "image").pixel.size() == 64U * 64);
}

BOOST_AUTO_TEST_CASE(nohup_keeps_a_run_going) {
  const TemporaryFolder folder;
  Child first(Arguments{"-c", "trap '' HUP; exec \"$0\" \"$@\"", MISFIT_PROGRAM} + small_image(snapshot(), folder / "a") +
                  Arguments{"--niter", "200", "--gain", "0.001", "--cycleniter", "5", "--quiet"},
              "sh");
  hang_up(first, folder);
  BOOST_TEST(first.wait().code == 0);
}

BOOST_AUTO_TEST_CASE(a_cache_folder_that_cannot_be_used_is_done_without) {
  const auto refuses = [](int error, bool opening_alone, const SystemCall& call) {
    const bool opens = call.number == SYS_openat || call.number == SYS_open || call.number == SYS_mkdir;
    return Answer{(opens || !opening_alone) ? error : 0};
  };
  for (const auto& [error, opening_alone] : {std::pair{EROFS, true}, {EACCES, true}, {ENOSPC, false}, {EIO, false}})
    BOOST_TEST_CONTEXT(std::strerror(error)) {
      const TemporaryFolder folder;
      const std::string cache = folder / "cache";
      const EnvironmentVariable fresh("MISFIT_CACHE", cache);
      products().restore();
      std::size_t refused = 0;
      std::vector<long> calls = changing_calls;
      calls.insert(calls.end(), reading_calls.begin(), reading_calls.end());
      const Outcome outcome =
          run_with_faults(products().run(), calls, [&, error = error, only = opening_alone](const auto& call) {
            if (call.path().rfind(cache, 0) != 0 || (!call.changes_file() && error != EACCES)) return Answer{};
            ++refused;
            return refuses(error, only, call);
          });
      BOOST_TEST(refused > 0U);
      BOOST_TEST(outcome.code == 0);
      BOOST_TEST(outcome.err == "");
      products().expect(products().made());
      if (fs::exists(cache)) BOOST_TEST(files_below(cache).empty());
    }
}

#ifndef MISFIT_SANITIZED  // whose own library must be loaded first
BOOST_AUTO_TEST_CASE(a_clock_that_jumps_changes_nothing) {
  const EnvironmentVariable preload("LD_PRELOAD", MISFIT_JUMPING_CLOCK);
  for (int run = 0; run < 3; ++run) {
    products().restore();
    const Outcome outcome = misfit::tools::testing::run(products().run());
    BOOST_TEST(outcome.code == 0, outcome.err);
    products().expect(products().made());
    const nlohmann::json seconds_of = report_of(products().path("a"))["timings_s"];
    BOOST_TEST(seconds_of.size() > 5U);
    for (const auto& [stage, seconds] : seconds_of.items())
      BOOST_TEST((seconds.get<double>() >= 0 && seconds.get<double>() < 600), stage << ' ' << seconds);
  }
}
#endif

BOOST_AUTO_TEST_SUITE_END()
