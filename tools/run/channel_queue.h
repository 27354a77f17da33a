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

/// What becomes of the channels of a run, at the rank that puts them together.
class ChannelSink {
 public:
  virtual ~ChannelSink() = default;
  /// A plane of the images of this kind, which another rank made. It may come while others are written.
  virtual void write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
                     const std::optional<imager::Beam>& beam) = 0;
  /// What came of a channel, whose images are written: of each in their order, one at a time.
  virtual void take(MadeChannel&& channel) = 0;
};

/// Who makes which channels of a run: whoever is free, of the ranks, takes the next batch, and rank 0 gets what comes of all.
/// It is the same for those who make them where there is one rank. Batches are taken by one thread of each rank; the rest may
/// be called by several.
class ChannelQueue {
 public:
  virtual ~ChannelQueue() = default;

  /// The channels to make next; none where all are given out, or, at other ranks, the user wants no more.
  virtual std::optional<imager::PlaneRange> next() = 0;
  /// After the images of the channel are written. A channel that the user stopped stops all.
  virtual void done(MadeChannel&& channel) = 0;
  /// Where images of this kind are written to: null at rank 0, which writes files.
  virtual std::unique_ptr<imager::ImageWriter> writer(const std::string& kind) = 0;
  /// The user wants no more: channels in CLEAN end after their major cycle, and others are not begun.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }
  /// One failed: those that are being made are of no use any more.
  void give_up() { given_up_ = true; }
  const std::atomic<bool>& given_up() const { return given_up_; }
  /// After the last: rank 0 waits until the others have ended, and hands on what waits for channels that will not come.
  /// Rethrows there what the sink threw.
  virtual void finish() = 0;

 private:
  std::atomic<bool> stopped_ = false;
  std::atomic<bool> given_up_ = false;
};

/// `ranks` and `sink`, which is rank 0's, are kept by reference. What the sink throws of others' channels is a reason to give
/// up. A queue of rank 0 that goes before finish() leaves the others without answers.
std::unique_ptr<ChannelQueue> make_channel_queue(const imager::Ranks& ranks, std::vector<imager::PlaneRange> batches,
                                                 ChannelSink& sink);

/// A part of the batches for each rank, where all ranks have the same to do with them.
std::vector<imager::PlaneRange> own_batches(const imager::Ranks& ranks, const std::vector<imager::PlaneRange>& batches);

}  // namespace misfit::tools
