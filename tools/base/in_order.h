#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <utility>

namespace misfit::tools {

/// Things with numbers that come in any order, from any thread, and are handed on one at a time in the order of their numbers.
template <typename Thing>
class InOrder {
 public:
  using HandOn = std::function<void(int number, Thing&& thing)>;

  /// The first that is handed on has number 0.
  explicit InOrder(HandOn hand_on) : hand_on_(std::move(hand_on)) {}

  /// Hands on all whose turn it is.
  void put(int number, Thing&& thing) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(number, std::move(thing));
    while (!waiting_.empty() && waiting_.begin()->first == next_) hand_on_first();
  }
  /// Hands on all that wait for numbers which will not come.
  void flush() {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty()) hand_on_first();
  }

 private:
  void hand_on_first() {
    auto first = waiting_.extract(waiting_.begin());
    next_ = first.key() + 1;
    hand_on_(first.key(), std::move(first.mapped()));
  }

  HandOn hand_on_;
  std::mutex mutex_;  ///< guards what follows
  std::map<int, Thing> waiting_;
  int next_ = 0;
};

}  // namespace misfit::tools
