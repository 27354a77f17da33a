#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/data/ranks.h"
#include "imager/files/image_writer.h"
#include "tools/run/channel_run.h"

namespace misfit::tools {

/// Takes the channels of a run, at the rank that puts them together.
class ChannelSink {
 public:
  virtual ~ChannelSink() = default;
  /// A plane of the images of this kind, which another rank made. It may come while others are written.
  virtual void write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
                     const std::optional<imager::Beam>& beam) = 0;
  /// Takes the results of a channel whose images are written; channels come in their order, one at a time.
  virtual void take(MadeChannel&& channel) = 0;
};

/// Hands out the channels of a run: a rank that is free takes the next batch, and rank 0 gets the results of all. One rank
/// alone uses it the same way. One thread of each rank calls next(); several threads may call the other functions.
class ChannelQueue {
 public:
  virtual ~ChannelQueue() = default;

  /// The channels to make next; none where all are given out, or, at other ranks, the user wants no more.
  virtual std::optional<imager::PlaneRange> next() = 0;
  /// To be called after the images of the channel are written. A channel that the user stopped stops all.
  virtual void done(MadeChannel&& channel) = 0;
  /// The writer that sends images of this kind to rank 0; null at rank 0, which writes files.
  virtual std::unique_ptr<imager::ImageWriter> writer(const std::string& kind) = 0;
  /// The user wants no more: channels in CLEAN end after their major cycle, and others are not begun.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }
  /// A channel failed: channels that are being made are of no use any more.
  void give_up() { given_up_ = true; }
  const std::atomic<bool>& given_up() const { return given_up_; }
  /// To be called after the last channel: rank 0 waits until the other ranks have ended, and hands on channels that wait for
  /// channels which will not come. Rethrows there what the sink threw.
  virtual void finish() = 0;

 private:
  std::atomic<bool> stopped_ = false;
  std::atomic<bool> given_up_ = false;
};

/// `ranks` and `sink`, which is rank 0's, are kept by reference. Where the sink throws on another rank's channel, the queue
/// gives up. A queue of rank 0 that is destroyed before finish() leaves the other ranks without answers.
std::unique_ptr<ChannelQueue> make_channel_queue(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches,
                                                 ChannelSink& sink);

/// This rank's part of the batches, where all ranks do the same with batches.
std::vector<imager::PlaneRange> own_batches(const imager::Ranks& ranks, const std::vector<imager::PlaneRange>& batches);

}  // namespace misfit::tools
