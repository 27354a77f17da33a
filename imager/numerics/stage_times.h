#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace misfit::imager {

/// The stages that are timed, and that a forecast speaks of.
namespace stage {
inline constexpr const char* open = "open";
inline constexpr const char* plan = "plan";
inline constexpr const char* read = "read";
inline constexpr const char* planes = "planes";
inline constexpr const char* weights = "weights";
inline constexpr const char* grid = "grid";
inline constexpr const char* degrid = "degrid";
inline constexpr const char* fft = "fft";
inline constexpr const char* exchange = "exchange";
inline constexpr const char* check_pixels = "check pixels";
inline constexpr const char* statistics = "statistics";
inline constexpr const char* verify = "verify";
inline constexpr const char* primary_beam = "primary beam";
inline constexpr const char* fit_beam = "fit beam";
inline constexpr const char* sources_outside = "sources outside";
inline constexpr const char* minor_cycles = "minor cycles";
inline constexpr const char* clean_state = "CLEAN state";
inline constexpr const char* restore = "restore";
inline constexpr const char* write_images = "write images";
inline constexpr const char* draw_pictures = "draw pictures";
}  // namespace stage

/// Where the time of a run went.
class StageTimes {
 public:
  /// Adds to a stage, in the order in which stages first appear.
  void add(const std::string& stage, double seconds) {
    for (auto& [name, total] : stages_)
      if (name == stage) {
        total += seconds;
        return;
      }
    stages_.emplace_back(stage, seconds);
  }
  /// Counts a part of one stage as another.
  void move(const std::string& from, const std::string& to, double seconds) {
    if (seconds == 0) return;
    add(from, -seconds);
    add(to, seconds);
  }
  /// Seconds of a stage so far.
  double of(const std::string& stage) const {
    for (const auto& [name, total] : stages_)
      if (name == stage) return total;
    return 0;
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

/// Seconds of wall clock since it was made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Adds the seconds that a step takes to a total.
template <typename Step>
void add_seconds_of(double& total, const Step& step) {
  const Stopwatch watch;
  step();
  total += watch.seconds();
}

/// Adds the time from its construction to its destruction.
class StageTimer {
 public:
  StageTimer(StageTimes& times, std::string stage) : StageTimer(&times, std::move(stage)) {}
  /// Nothing is timed where `times` is null.
  StageTimer(StageTimes* times, std::string stage) : times_(times), stage_(std::move(stage)) {}
  ~StageTimer() {
    if (times_ != nullptr) times_->add(stage_, watch_.seconds());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes* times_;
  std::string stage_;
  Stopwatch watch_;
};

}  // namespace misfit::imager
