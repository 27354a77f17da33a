#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace misfit::tools {

/// Sends the lines of all runs to `tell`, which any thread may call, and not to stderr; no line is live then. An empty `tell`
/// stands for stderr again. Not to be called during a run.
void tell_lines(std::function<void(const std::string&)> tell);

/// Says on stderr what a run is doing: on a terminal one live line with percentage and time left, elsewhere a plain line when a
/// stage ends. Throws Interrupted from update() once the user asked to stop, unless a stage finishes by itself. Any thread may
/// call it.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();

  void begin(const std::string& stage, bool stops_itself = false);
  void update(std::uint64_t done, std::uint64_t total);
  void end();
  /// A line of its own, whatever stage is running.
  void say(const std::string& line);

 private:
  double elapsed_s() const;
  void clear();

  bool quiet_;
  bool live_;
  std::mutex mutex_;  ///< guards what follows
  bool open_ = false;
  bool stops_itself_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace misfit::tools
