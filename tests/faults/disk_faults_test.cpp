// What a run leaves when its disk fails it, at every single place where it changes a file.
#include <sys/syscall.h>

#include <cstring>
#include <regex>

#include "tests/faults/faulty_run.h"

BOOST_AUTO_TEST_SUITE(disk_faults)

namespace {

namespace fs = std::filesystem;
using namespace misfit::tools::testing;
using misfit::testing::changing_calls;

using Files = std::map<std::string, std::string>;  ///< contents by name

Files files_in(const std::string& folder) {
  Files files;
  for (const auto& [path, bytes] : files_below(folder)) files[fs::relative(path, folder)] = bytes;
  return files;
}

/// A run that makes every kind of file, with pixels that differ from those of another robustness.
Arguments clean(const std::string& folder, const std::string& robust) {
  return small_image(snapshot(), folder + "a") +
         Arguments{"--niter", "20", "--weighting", "briggs", "--robust", robust, "--threads", "1"};
}

/// Whether a file whose bytes tell of the time is a whole one.
bool is_whole(const std::string& name, const std::string& bytes) {
  const auto ends_with = [](const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_with(name, ".clean.state")) return !nlohmann::json::from_cbor(bytes, false, false).is_discarded();
  if (ends_with(name, ".json")) return nlohmann::json::accept(bytes);
  return ends_with(name, ".html") && ends_with(bytes, "</html>\n");
}

/// Of a file that may not be complete yet.
std::string final_name(const std::string& path) {
  return std::regex_replace(path, std::regex("(\\.[0-9a-f]{8,16})?\\.part$"), "");
}

/// Where files of an earlier run lie, and another one is about to replace them.
class Scene {
 public:
  Scene() {
    for (const bool after : {false, true}) {
      succeed(clean(folder_ / "", after ? "0.5" : "-0.5"));
      (after ? after_ : before_) = files_in(folder_ / "");
    }
    set_ = files_below(snapshot());
  }

  /// Calls a run, with each of its calls that `concerns` picks failing in turn, by what `fault` answers.
  void run_with_each(const std::function<bool(const SystemCall&)>& concerns, const std::function<Answer(std::size_t)>& fault,
                     const std::string& said) const {
    std::size_t failing = 0, calls = 0;
    do {
      for (const auto& file : fs::directory_iterator(folder_ / "")) fs::remove(file.path());
      for (const auto& [name, bytes] : before_) std::ofstream(folder_ / name, std::ios::binary) << bytes;
      calls = 0;
      std::string failed;
      const Outcome outcome = run_with_faults(clean(folder_ / "", "0.5") + Arguments{"--quiet"}, changing_calls, [&](const SystemCall& call) {
        const std::string path = call.path();
        if (path.rfind(folder_ / "a.", 0) != 0 || !concerns(call)) return Answer{};
        if (path == folder_ / "a.lock" && call.number != SYS_openat) return Answer{};  // who holds it is told as a courtesy
        if (calls++ < failing) return Answer{};
        if (failed.empty()) failed = path;
        return fault(calls - 1 - failing);
      });
      if (calls > failing) BOOST_TEST_CONTEXT("call " << failing << ", of " << failed << ": " << outcome.err) {
          BOOST_TEST(outcome.code == 1);
          BOOST_TEST(outcome.err.find(said) != std::string::npos);
          BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
          BOOST_TEST(outcome.err.find(final_name(failed)) != std::string::npos);
          expect_whole(files_in(folder_ / ""));
        }
      ++failing;
    } while (calls >= failing);
    BOOST_TEST(failing > 10U);
    BOOST_TEST((files_below(snapshot()) == set_));
  }

 private:
  void expect_whole(const Files& files) const {
    for (const auto& [name, bytes] : files) {
      const auto old = before_.find(name), made = after_.find(name);
      const bool as_before = old != before_.end() && bytes == old->second;
      BOOST_TEST((as_before || (made != after_.end() && bytes == made->second) || is_whole(name, bytes)), name);
    }
  }

  TemporaryFolder folder_;  // one for all, as headers tell of it
  Files before_, after_, set_;
};

const Scene& scene() {
  static const Scene scene;
  return scene;
}

bool writes(const SystemCall& call) {
  return call.number == SYS_write || call.number == SYS_writev || call.number == SYS_pwrite64;
}

bool takes_room(const SystemCall& call) {
  return writes(call) || call.number == SYS_mkdir || (call.number == SYS_openat && call.changes_file());
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_full_disk_is_told_of_and_leaves_whole_files) {
  scene().run_with_each(takes_room, [](std::size_t) { return Answer{ENOSPC}; }, std::strerror(ENOSPC));
}

BOOST_AUTO_TEST_CASE(a_write_that_fails_half_way_leaves_whole_files) {
  scene().run_with_each(
      writes, [](std::size_t later) { return later == 0 ? Answer{0, true} : Answer{ENOSPC}; }, std::strerror(ENOSPC));
}

BOOST_AUTO_TEST_CASE(a_disk_that_fails_is_told_of_and_leaves_whole_files) {
  const auto concerns = [](const SystemCall& call) { return call.changes_file() && call.number != SYS_unlink; };
  scene().run_with_each(concerns, [](std::size_t) { return Answer{EIO}; }, std::strerror(EIO));
}

BOOST_AUTO_TEST_SUITE_END()
