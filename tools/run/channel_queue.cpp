#include "tools/run/channel_queue.h"

#include <chrono>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/base/in_order.h"
#include "tools/run/channel_messages.h"

namespace misfit::tools {
namespace {

/// The queue of rank 0. A thread of its own answers the other ranks, one message at a time.
class FirstQueue : public ChannelQueue {
 public:
  FirstQueue(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches, ChannelSink& sink)
      : ranks_(ranks),
        batches_(std::move(batches)),
        sink_(sink),
        in_order_([this](int, MadeChannel&& channel) { sink_.take(std::move(channel)); }),
        at_work_(ranks.size() - 1) {}

  FirstQueue(const FirstQueue&) = delete;
  FirstQueue& operator=(const FirstQueue&) = delete;
  ~FirstQueue() override {
    left_ = true;
    if (thread_.joinable()) thread_.join();
  }

  std::optional<imager::PlaneRange> next() override {
    answer_others();
    return next_batch();
  }

  void done(MadeChannel&& channel) override {
    if (channel.stopped()) stop();
    const int number = channel.report.channel;
    in_order_.put(number, std::move(channel));
  }

  std::unique_ptr<imager::ImageWriter> writer(const std::string&) override { return nullptr; }

  void finish() override {
    answer_others();
    if (thread_.joinable()) thread_.join();
    if (thrown_) std::rethrow_exception(thrown_);
    in_order_.flush();
  }

 private:
  std::optional<imager::PlaneRange> next_batch() {
    const std::size_t number = next_++;
    if (number >= batches_.size()) return {};
    return batches_[number];
  }

  /// Begins to answer other ranks, unless none is left.
  void answer_others() {
    if (at_work_ > 0 && !thread_.joinable()) thread_ = std::thread([this] { keep_answering(); });
  }

  void keep_answering() {
    try {
      while (at_work_ > 0 && !left_) {
        if (const std::optional<int> rank = ranks_.waiting())
          answer(*rank, channel_message(ranks_.receive(*rank)));
        else
          std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    } catch (...) {
      thrown_ = std::current_exception();
      give_up();
    }
  }

  void answer(int rank, ChannelMessage&& message) {
    ChannelAnswer answer;
    switch (message.kind) {
      case ChannelMessage::Kind::next:
        if (!stopped()) answer.channels = next_batch();
        break;
      case ChannelMessage::Kind::image:
        sink_.write(message.image_kind, message.at, message.image, message.beam);
        break;
      case ChannelMessage::Kind::channel:
        done(std::move(message.channel));
        break;
      case ChannelMessage::Kind::stopped:
        stop();
        break;
      case ChannelMessage::Kind::ended:
        --at_work_;
        break;
    }
    answer.stop = stopped();
    ranks_.send(rank, bytes_of(answer));
  }

  const imager::Ranks& ranks_;
  const std::vector<imager::PlaneRange> batches_;
  ChannelSink& sink_;
  InOrder<MadeChannel> in_order_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<int> at_work_;  ///< other ranks that have not ended
  std::atomic<bool> left_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;
};

/// The queue of another rank.
class FarQueue : public ChannelQueue {
 public:
  explicit FarQueue(const imager::Ranks& ranks) : ranks_(ranks) {}

  std::optional<imager::PlaneRange> next() override { return tell({.kind = ChannelMessage::Kind::next}).channels; }

  void done(MadeChannel&& channel) override {
    if (channel.stopped()) stop();
    tell({.kind = ChannelMessage::Kind::channel, .channel = std::move(channel)});
  }

  std::unique_ptr<imager::ImageWriter> writer(const std::string& kind) override {
    return std::make_unique<SentImage>(*this, kind);
  }

  void finish() override {
    if (stopped()) tell({.kind = ChannelMessage::Kind::stopped});
    tell({.kind = ChannelMessage::Kind::ended});
  }

 private:
  /// An image whose planes go to rank 0.
  class SentImage : public imager::ImageWriter {
   public:
    SentImage(FarQueue& queue, std::string kind) : queue_(queue), kind_(std::move(kind)) {}

    void write(const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam) override {
      queue_.tell(
          {.kind = ChannelMessage::Kind::image, .image_kind = kind_, .at = at, .image = image, .beam = beam, .channel = {}});
    }
    void add_cards(const std::vector<imager::HeaderCard>&) override { throw_not_here(); }
    void finish() override { throw_not_here(); }

   private:
    [[noreturn]] static void throw_not_here() { throw std::logic_error("rank 0 finishes the files"); }

    FarQueue& queue_;
    std::string kind_;
  };

  ChannelAnswer tell(const ChannelMessage& message) {
    const std::string bytes = bytes_of(message);
    const std::lock_guard lock(one_at_a_time_);
    ranks_.send(0, bytes);
    const ChannelAnswer answer = channel_answer(ranks_.receive(0));
    if (answer.stop) stop();
    return answer;
  }

  const imager::Ranks& ranks_;
  std::mutex one_at_a_time_;
};

}  // namespace

std::unique_ptr<ChannelQueue> make_channel_queue(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches,
                                                 ChannelSink& sink) {
  if (!ranks.first()) return std::make_unique<FarQueue>(ranks);
  return std::make_unique<FirstQueue>(ranks, std::move(batches), sink);
}

std::vector<imager::PlaneRange> own_batches(const imager::Ranks& ranks, const std::vector<imager::PlaneRange>& batches) {
  std::vector<imager::PlaneRange> own;
  const auto size = static_cast<std::size_t>(ranks.size());
  for (auto b = static_cast<std::size_t>(ranks.rank()); b < batches.size(); b += size) own.push_back(batches[b]);
  return own;
}

}  // namespace misfit::tools
