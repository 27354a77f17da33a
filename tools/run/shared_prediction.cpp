#include "tools/run/shared_prediction.h"

#include <condition_variable>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace misfit::tools {
namespace {

/// Lists one after the other, each after its length.
class Message {
 public:
  Message() = default;
  explicit Message(std::string bytes) : bytes_(std::move(bytes)) {}

  template <typename Value>
  void put(const Value* values, std::size_t count) {
    const auto length = static_cast<std::uint64_t>(count);
    bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
    bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
  }
  template <typename Value>
  std::vector<Value> take() {
    std::uint64_t length = 0;
    read(&length, sizeof length);
    if (length > (bytes_.size() - next_) / sizeof(Value)) throw std::runtime_error("ranks sent a message that ends early");
    std::vector<Value> values(length);
    read(values.data(), length * sizeof(Value));
    return values;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void read(void* to, std::size_t count) {
    if (count == 0) return;
    if (count > bytes_.size() - next_) throw std::runtime_error("ranks sent a message that ends early");
    std::memcpy(to, bytes_.data() + next_, count);
    next_ += count;
  }

  std::string bytes_;
  std::size_t next_ = 0;
};

std::string packed(const imager::SampleCoordinates& where) {
  Message message;
  message.put(where.uvw_m.data(), where.uvw_m.size());
  message.put(where.frequency_hz.data(), where.frequency_hz.size());
  return message.bytes();
}

imager::SampleCoordinates coordinates(std::string bytes) {
  Message message(std::move(bytes));
  imager::SampleCoordinates where;
  where.uvw_m = message.take<double>();
  where.frequency_hz = message.take<double>();
  return where;
}

std::string packed(const ms_io::StokesVisibilities& visibilities) {
  Message message;
  for (const auto& plane : visibilities.plane) message.put(plane.data(), plane.size());
  return message.bytes();
}

ms_io::StokesVisibilities visibilities(std::string bytes) {
  Message message(std::move(bytes));
  ms_io::StokesVisibilities all;
  for (auto& plane : all.plane) plane = message.take<std::complex<double>>();
  return all;
}

}  // namespace

/// Which ranks have nothing to do.
class SharedPrediction::FreeRanks {
 public:
  explicit FreeRanks(int size) {
    for (int rank = 0; rank < size; ++rank) free_.push_back(rank);
  }
  /// One of them, which is waited for, and is free again at the end of this.
  struct Turn {
    explicit Turn(FreeRanks& all) : from(all), rank(all.take()) {}
    ~Turn() { from.give_back(rank); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    FreeRanks& from;
    const int rank;
  };

 private:
  int take() {
    std::unique_lock lock(mutex_);
    there_is_one_.wait(lock, [&] { return !free_.empty(); });
    const int rank = free_.back();
    free_.pop_back();
    return rank;
  }
  void give_back(int rank) {
    {
      const std::lock_guard lock(mutex_);
      free_.push_back(rank);
    }
    there_is_one_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable there_is_one_;
  std::vector<int> free_;
};

SharedPrediction::SharedPrediction(const imager::Ranks& ranks, const ms_io::Predict& own)
    : ranks_(ranks), own_(own), free_(std::make_unique<FreeRanks>(ranks.size())) {}

SharedPrediction::~SharedPrediction() = default;

ms_io::StokesVisibilities SharedPrediction::predict(const imager::SampleCoordinates& where) {
  const FreeRanks::Turn turn(*free_);
  if (turn.rank == ranks_.rank()) return own_(where);
  ranks_.send(turn.rank, packed(where));
  return visibilities(ranks_.receive(turn.rank));
}

void SharedPrediction::end() {
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, "");
}

void SharedPrediction::follow() {
  for (std::string bytes = ranks_.receive(0); !bytes.empty(); bytes = ranks_.receive(0))
    ranks_.send(0, packed(own_(coordinates(std::move(bytes)))));
}

}  // namespace misfit::tools
