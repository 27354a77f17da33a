#pragma once

#include <regex>

#include "tests/faults/faulty_run.h"

namespace misfit::tools::testing {

using Files = std::map<std::string, std::string>;  ///< contents by name

inline bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Whether a file whose bytes tell of the time, or how far a run is, is a whole one.
inline bool is_whole(const std::string& name, const std::string& bytes) {
  if (ends_with(name, ".clean.state")) return !nlohmann::json::from_cbor(bytes, false, false).is_discarded();
  if (ends_with(name, ".json")) return nlohmann::json::accept(bytes);
  return ends_with(name, ".html") && ends_with(bytes, "</html>\n");
}

/// The same of other files, that hold less after fewer components.
inline bool is_whole_after_less(const std::string& name, const std::string& bytes) {
  if (ends_with(name, ".fits")) return bytes.size() % 2880 == 0 && bytes.size() >= 2880 + 64 * 64 * 4;
  if (ends_with(name, ".png")) return ends_with(bytes, "IEND\xae\x42\x60\x82");
  return ends_with(name, ".csv") && ends_with(bytes, "\n");
}

/// A folder with all that a run leaves, which another one, whose pixels differ, is about to replace.
class ReplacedProducts {
 public:
  ReplacedProducts() : set_(files_below(snapshot())) {
    succeed(clean("-0.5"));
    before_ = files();
    succeed(clean("0.5"));
    after_ = files();
  }

  /// Of the run that replaces them.
  Arguments run() const { return clean("0.5") + Arguments{"--quiet"}; }
  std::string path(const std::string& name) const { return folder_ / name; }
  /// Everything as the first run left it.
  void restore() const {
    for (const auto& file : std::filesystem::directory_iterator(path(""))) std::filesystem::remove(file.path());
    for (const auto& [name, bytes] : before_) std::ofstream(path(name), std::ios::binary) << bytes;
  }
  /// Each file is the first run's, or a whole one of the second, which may have been `stopped` early. Those that are being
  /// written while it is `running` have other names.
  void expect_whole(bool running = false, bool stopped = false) const {
    for (const auto& [name, bytes] : files()) {
      if (running && (name == "a.lock" || std::regex_search(name, std::regex(R"(\.[0-9a-f]{16}\.part$)")))) continue;
      const auto old = before_.find(name), made = after_.find(name);
      const bool as_before = old != before_.end() && bytes == old->second;
      const bool as_after = (made != after_.end() && bytes == made->second) || (stopped && is_whole_after_less(name, bytes));
      BOOST_TEST((as_before || as_after || is_whole(name, bytes)), name);
    }
  }
  Files files() const {
    Files files;
    for (const auto& [name, bytes] : files_below(path(""))) files[std::filesystem::relative(name, path(""))] = bytes;
    return files;
  }
  /// Each file is as another run made it.
  void expect(const Files& made) const {
    const Files now = files();
    for (const auto& [name, bytes] : now) {
      const auto other = made.find(name);
      BOOST_TEST(((other != made.end() && bytes == other->second) || is_whole(name, bytes)), name);
    }
    BOOST_TEST(now.size() == made.size());
  }
  /// Of the run that replaces them.
  const Files& made() const { return after_; }
  void expect_set_unharmed() const { BOOST_TEST((files_below(snapshot()) == set_)); }
  /// Whether the call is about a file of theirs.
  bool concerns(const SystemCall& call) const { return call.path().rfind(path("a."), 0) == 0; }

 private:
  Arguments clean(const std::string& robust) const {
    return small_image(snapshot(), path("a")) +
           Arguments{"--niter", "20", "--weighting", "briggs", "--robust", robust, "--threads", "1"};
  }
  TemporaryFolder folder_;  // one for both, as headers tell of it
  Files before_, after_, set_;
};

/// The same for all tests of a file.
inline const ReplacedProducts& products() {
  static const ReplacedProducts products;
  return products;
}

}  // namespace misfit::tools::testing
