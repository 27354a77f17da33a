#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "imager/numerics/stage_times.h"

namespace misfit::imager {

/// Called after every block with the samples done and their total. It may throw to end the work.
using Progress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// The threads that work may use, and whom it tells of its progress: handed on from a run to all its functions.
struct Context {
  int threads = 1;
  StageTimes* times = nullptr;  ///< where stages are timed; null: nowhere
  Progress progress = {};       ///< may be empty

  void tell(std::uint64_t done, std::uint64_t total) const {
    if (progress) progress(done, total);
  }
  /// Counts a part of one stage as another.
  void move_seconds(const std::string& from, const std::string& to, double seconds) const {
    if (times != nullptr) times->move(from, to, seconds);
  }
};

}  // namespace misfit::imager
