#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace misfit::imager {

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
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

/// Adds the time from its construction to its destruction.
class StageTimer {
 public:
  StageTimer(StageTimes& times, std::string stage) : times_(times), stage_(std::move(stage)) {}
  ~StageTimer() { times_.add(stage_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace misfit::imager
