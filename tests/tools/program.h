#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "imager/files/fits_image.h"
#include "tests/observations.h"

namespace misfit::tools::testing {

using misfit::testing::TemporaryFolder;

using Arguments = std::vector<std::string>;

inline Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// What a run of the program said, and how it ended.
struct Outcome {
  int code = -1;  ///< exit code, or minus the signal that ended it
  std::string out;
  std::string err;
};

/// Where programs keep kernels that they solved, unless a test says otherwise: not where the user's lie.
inline const std::string& kernel_cache() {
  static const TemporaryFolder folder;
  static const std::string path = folder / "cache";
  return path;
}

/// Lets tests/stand_ins draw the pictures of the program, which by gnuplot take most of a small run's time; where
/// MISFIT_TEST_GNUPLOT is set gnuplot draws them.
inline void draw_dots() {
  if (std::getenv("MISFIT_TEST_GNUPLOT") != nullptr) return;
  const char* const path = std::getenv("PATH");
  setenv("PATH", (std::string(MISFIT_SOURCE_DIR) + "/tests/stand_ins:" + (path == nullptr ? "" : path)).c_str(), 1);
}

/// Turns a child process into another program, found on PATH, whose output goes to files.
[[noreturn]] inline void become(const std::string& program, const Arguments& arguments, const std::string& out,
                                const std::string& err, const std::string& cache) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  setenv("MISFIT_CACHE", cache.c_str(), 0);
  draw_dots();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);  // whoever started the tests may ignore them
  dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
  dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
  execvp(argv[0], argv.data());
  _exit(127);
}

/// The program as a child process, or another one found on PATH; its output goes to files in a folder of its own.
class Child {
 public:
  explicit Child(const Arguments& arguments, const std::string& program = MISFIT_PROGRAM) {
    const std::string out = folder_ / "out", err = folder_ / "err", cache = kernel_cache();
    pid_ = fork();
    BOOST_REQUIRE(pid_ >= 0);
    if (pid_ == 0) become(program, arguments, out, err, cache);
  }

  /// Waits until stderr holds `text`, or the program has ended.
  void wait_for(const std::string& text) {
    wait_until([&] { return content(folder_ / "err").find(text) != std::string::npos; });
  }
  /// Waits until `there`, or the program has ended.
  void wait_until(const std::function<bool()>& there) {
    while (!ended() && !there()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  /// The processes that it started.
  std::vector<pid_t> children() const {
    std::istringstream listed(content("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) + "/children"));
    std::vector<pid_t> all;
    for (pid_t child; listed >> child;) all.push_back(child);
    return all;
  }
  bool ended() {
    if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  void signal(int number) const { kill(pid_, number); }
  /// Its outcome; where it has not ended by then, it is killed and its code is −SIGKILL.
  Outcome wait_at_most(std::chrono::seconds longest) {
    const auto start = std::chrono::steady_clock::now();
    wait_until([&] { return std::chrono::steady_clock::now() - start > longest; });
    if (!ended()) signal(SIGKILL);
    return wait();
  }
  Outcome wait() {
    if (!ended_) waitpid(pid_, &status_, 0);
    ended_ = true;
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_), content(folder_ / "out"), content(folder_ / "err")};
  }

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

inline Outcome run(const Arguments& arguments) {
  return Child(arguments).wait();
}

/// Runs the program, which must succeed.
inline void succeed(const Arguments& arguments) {
  const Outcome outcome = run(arguments + Arguments{"--quiet"});
  BOOST_TEST_INFO(outcome.err);
  BOOST_REQUIRE_EQUAL(outcome.code, 0);
  BOOST_TEST(outcome.err == "");
  BOOST_TEST(outcome.out == "");
}

inline nlohmann::json report_of(const std::string& imagename) {
  return nlohmann::json::parse(content(imagename + ".report.json"));
}

inline imager::Image pixels_of(const std::string& imagename, const std::string& kind) {
  return imager::read_fits(imagename + "." + kind + ".fits").image;
}

/// Of the environment, for the programs started while it lives.
class EnvironmentVariable {
 public:
  EnvironmentVariable(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* const before = std::getenv(name_.c_str())) before_ = before;
    setenv(name_.c_str(), value.c_str(), 1);
  }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;
  ~EnvironmentVariable() { before_ ? setenv(name_.c_str(), before_->c_str(), 1) : unsetenv(name_.c_str()); }

 private:
  std::string name_;
  std::optional<std::string> before_;
};

/// Names of everything in the folder of `path`, and below.
inline std::map<std::string, std::string> files_below(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    files[entry.path()] = entry.is_regular_file() ? content(entry.path()) : "";
  return files;
}

/// A snapshot of the test card: 351 visibilities, VLA A-array at 4 GHz, cell 0.05 arcsec.
inline const std::string& snapshot() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    succeed({"simulate", "--output", folder / "snapshot.ms"});
    return folder / "snapshot.ms";
  }();
  return path;
}

/// An hour of it, 21 060 visibilities without noise.
inline const std::string& track() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    succeed({"simulate", "--output", folder / "track.ms", "--hours", "1", "--interval", "60"});
    return folder / "track.ms";
  }();
  return path;
}

/// A small image of the snapshot, where only files and counts matter.
inline Arguments small_image(const std::string& vis, const std::string& imagename) {
  return {"image", "--vis", vis, "--imagename", imagename, "--imsize", "64", "--cell", "0.1arcsec"};
}

}  // namespace misfit::tools::testing
