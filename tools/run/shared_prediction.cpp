#include "tools/run/shared_prediction.h"

#include <cereal/types/vector.hpp>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/packed.h"

// The members that are sent, in their order. cereal finds these functions by the types' namespaces.

namespace misfit::imager {

template <typename Archive>
void save(Archive& archive, const SampleCoordinates& where) {
  archive(static_cast<std::uint64_t>(where.uvw_m.size()));
  archive(cereal::binary_data(where.uvw_m.data(), where.uvw_m.size() * sizeof(double)), where.frequency_hz);
  archive(static_cast<std::uint64_t>(where.sights.size()));
  archive(cereal::binary_data(where.sights.data(), where.sights.size() * sizeof(RowSight)));
}

template <typename Archive>
void load(Archive& archive, SampleCoordinates& where) {
  std::uint64_t size = 0;
  archive(size);
  std::vector<double> uvw_m(size);
  archive(cereal::binary_data(uvw_m.data(), uvw_m.size() * sizeof(double)), where.frequency_hz);
  where.uvw_m = std::move(uvw_m);
  archive(size);
  where.sights.resize(size);
  archive(cereal::binary_data(where.sights.data(), where.sights.size() * sizeof(RowSight)));
}

}  // namespace misfit::imager

namespace misfit::ms_io {

template <typename Archive>
void save(Archive& archive, const StokesVisibilities& visibilities) {
  for (const auto& plane : visibilities.plane) {
    archive(static_cast<std::uint64_t>(plane.size()));
    archive(cereal::binary_data(plane.data(), plane.size() * sizeof plane[0]));
  }
}

template <typename Archive>
void load(Archive& archive, StokesVisibilities& visibilities) {
  for (auto& plane : visibilities.plane) {
    std::uint64_t size = 0;
    archive(size);
    plane.resize(size);
    archive(cereal::binary_data(plane.data(), plane.size() * sizeof plane[0]));
  }
}

}  // namespace misfit::ms_io

namespace misfit::tools {

/// The ranks that have nothing to do.
class SharedPrediction::FreeRanks {
 public:
  explicit FreeRanks(int size) {
    for (int rank = 0; rank < size; ++rank) free_.push_back(rank);
  }
  /// A free rank, which is waited for, and is free again when this ends.
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
  return unpacked<ms_io::StokesVisibilities>(ranks_.receive(turn.rank));
}

void SharedPrediction::end() {
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, "");
}

void SharedPrediction::follow() {
  for (std::string bytes = ranks_.receive(0); !bytes.empty(); bytes = ranks_.receive(0))
    ranks_.send(0, packed(own_(unpacked<imager::SampleCoordinates>(std::move(bytes)))));
}

}  // namespace misfit::tools
