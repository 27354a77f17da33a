#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "imager/data/ranks.h"
#include "tools/run/plane_messages.h"

namespace misfit::tools {

/// Rank 0 of a cube whose planes ranks make: deals out batches of planes, and takes what comes of those of others.
class PlaneDealer {
 public:
  /// What is done with what others send, in a thread of its own, one thing at a time.
  struct Taker {
    std::function<void(int file, const imager::PlaneIndex& at, const imager::Image& image,
                       const std::optional<imager::Beam>& beam)>
        write;
    std::function<void(CubePlane&& plane)> take;
    std::function<void()> stop;     ///< the user wants no more, and told another rank
    std::function<bool()> stopped;  ///< whether others shall make no more
    std::function<void()> failed;   ///< one of these threw: nothing is of any use any more
  };

  /// `ranks` is kept by reference. Answers others from here on.
  PlaneDealer(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches, Taker taker);
  /// Leaves others to themselves, which get no answers any more.
  ~PlaneDealer();
  PlaneDealer(const PlaneDealer&) = delete;
  PlaneDealer& operator=(const PlaneDealer&) = delete;

  /// The planes that rank 0 makes next; none where all are given out.
  std::optional<imager::PlaneRange> next();
  /// Waits until the others have ended. Rethrows what `taker` threw.
  void finish();

 private:
  void answer_others();
  void answer(int rank, PlaneMessage&& message);

  const imager::Ranks& ranks_;
  const std::vector<imager::PlaneRange> batches_;
  Taker taker_;
  std::atomic<std::size_t> next_ = 0;
  int at_work_;  ///< others that have not ended
  std::atomic<bool> left_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;
};

/// Rank 0 of such a cube, as others see it. Several threads may call it.
class PlaneLink {
 public:
  /// `ranks` is kept by reference.
  explicit PlaneLink(const imager::Ranks& ranks) : ranks_(ranks) {}

  /// The planes that this rank makes next; none where all are given out, or the user wants no more.
  std::optional<imager::PlaneRange> next();
  /// A file that rank 0 writes. The files of a cube are opened in the same order by all.
  std::unique_ptr<imager::ImageWriter> open();
  void put(CubePlane&& plane);
  /// The user wants no more, and told this rank.
  void stop();
  /// Whether rank 0 told of the user that wants no more.
  bool stopped() const { return stopped_; }
  /// After all others.
  void end();

 private:
  class SentImage;

  PlaneAnswer tell(const PlaneMessage& message);

  const imager::Ranks& ranks_;
  int files_ = 0;
  std::mutex one_at_a_time_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace misfit::tools
