#include "imager/streaming/prefetch.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <thread>
#include <utility>

namespace misfit::imager {
namespace {

class Prefetched : public BlockStream {
 public:
  Prefetched(std::unique_ptr<BlockStream> stream, std::size_t ahead) : stream_(std::move(stream)), ahead_(ahead) {
    reader_ = std::thread([this] { read(); });
  }
  ~Prefetched() override {
    {
      const std::lock_guard lock(mutex_);
      unwanted_ = true;
    }
    changed_.notify_all();
    reader_.join();
  }

  std::shared_ptr<const VisibilityBlock> next() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !waiting_.empty() || ended_; });
    if (waiting_.empty()) {
      if (failure_) std::rethrow_exception(failure_);
      return nullptr;
    }
    auto block = std::move(waiting_.front());
    waiting_.pop();
    changed_.notify_all();
    return block;
  }

 private:
  void read() {
    std::unique_lock lock(mutex_);
    while (!ended_) {
      changed_.wait(lock, [this] { return waiting_.size() < ahead_ || unwanted_; });
      if (unwanted_) return;
      lock.unlock();
      std::shared_ptr<const VisibilityBlock> block;
      std::exception_ptr failure;
      try {
        block = stream_->next();
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      ended_ = !block;
      failure_ = failure;
      if (block) waiting_.push(std::move(block));
      changed_.notify_all();
    }
  }

  std::unique_ptr<BlockStream> stream_;  ///< the reader's alone
  const std::size_t ahead_;

  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::queue<std::shared_ptr<const VisibilityBlock>> waiting_;
  bool ended_ = false;
  bool unwanted_ = false;
  std::exception_ptr failure_;

  std::thread reader_;
};

}  // namespace

std::unique_ptr<BlockStream> prefetched(std::unique_ptr<BlockStream> stream, std::size_t ahead) {
  if (ahead == 0) return stream;
  return std::make_unique<Prefetched>(std::move(stream), ahead);
}

}  // namespace misfit::imager
