#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace misfit::imager {

/// Things that threads use one after the other, made when none is free: fresh memory from the system is costly.
template <typename T>
class Spares {
 public:
  template <typename Make>
  std::unique_ptr<T> take(const Make& make) {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return make();
    std::unique_ptr<T> one = std::move(spare_.back());
    spare_.pop_back();
    return one;
  }
  void give_back(std::unique_ptr<T> one) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(one));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace misfit::imager
