#include "tools/run/shared_cube.h"

#include <chrono>
#include <stdexcept>
#include <utility>

namespace misfit::tools {

PlaneDealer::PlaneDealer(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches, Taker taker)
    : ranks_(ranks), batches_(std::move(batches)), taker_(std::move(taker)), at_work_(ranks.size() - 1) {
  if (at_work_ > 0) thread_ = std::thread([this] { answer_others(); });
}

PlaneDealer::~PlaneDealer() {
  left_ = true;
  if (thread_.joinable()) thread_.join();
}

std::optional<imager::PlaneRange> PlaneDealer::next() {
  const std::size_t number = next_++;
  if (number >= batches_.size()) return {};
  return batches_[number];
}

void PlaneDealer::finish() {
  if (thread_.joinable()) thread_.join();
  if (thrown_) std::rethrow_exception(thrown_);
}

void PlaneDealer::answer_others() {
  try {
    while (at_work_ > 0 && !left_) {
      if (const std::optional<int> rank = ranks_.waiting())
        answer(*rank, plane_message(ranks_.receive(*rank)));
      else
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  } catch (...) {
    thrown_ = std::current_exception();
    taker_.failed();
  }
}

void PlaneDealer::answer(int rank, PlaneMessage&& message) {
  PlaneAnswer answer;
  switch (message.kind) {
    case PlaneMessage::Kind::next:
      if (!taker_.stopped()) answer.planes = next();
      break;
    case PlaneMessage::Kind::image:
      taker_.write(message.file, message.at, message.image, message.beam);
      break;
    case PlaneMessage::Kind::plane:
      taker_.take(std::move(message.plane));
      break;
    case PlaneMessage::Kind::stopped:
      taker_.stop();
      break;
    case PlaneMessage::Kind::ended:
      --at_work_;
      break;
  }
  answer.stop = taker_.stopped();
  ranks_.send(rank, bytes_of(answer));
}

/// What is written of it goes to rank 0.
class PlaneLink::SentImage : public imager::ImageWriter {
 public:
  SentImage(PlaneLink& link, int file) : link_(link), file_(file) {}

  void write(const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam) override {
    link_.tell({PlaneMessage::Kind::image, file_, at, image, beam, {}});
  }
  void add_cards(const std::vector<imager::HeaderCard>&) override { throw_not_here(); }
  void finish() override { throw_not_here(); }

 private:
  [[noreturn]] static void throw_not_here() { throw std::logic_error("rank 0 finishes the files"); }

  PlaneLink& link_;
  int file_;
};

std::optional<imager::PlaneRange> PlaneLink::next() {
  return tell({PlaneMessage::Kind::next, 0, {}, {}, {}, {}}).planes;
}

std::unique_ptr<imager::ImageWriter> PlaneLink::open() {
  return std::make_unique<SentImage>(*this, files_++);
}

void PlaneLink::put(CubePlane&& plane) {
  tell({PlaneMessage::Kind::plane, 0, {}, {}, {}, std::move(plane)});
}

void PlaneLink::stop() {
  tell({PlaneMessage::Kind::stopped, 0, {}, {}, {}, {}});
}

void PlaneLink::end() {
  tell({PlaneMessage::Kind::ended, 0, {}, {}, {}, {}});
}

PlaneAnswer PlaneLink::tell(const PlaneMessage& message) {
  const std::string bytes = bytes_of(message);
  const std::lock_guard lock(one_at_a_time_);
  ranks_.send(0, bytes);
  const PlaneAnswer answer = plane_answer(ranks_.receive(0));
  if (answer.stop) stopped_ = true;
  return answer;
}

}  // namespace misfit::tools
