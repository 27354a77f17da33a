#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/cube/plane_gatherer.h"
#include "imager/streaming/streamed_visibilities.h"
#include "ms_io/measurement_set.h"
#include "tools/base/progress.h"
#include "tools/run/channel_batches.h"

namespace misfit::tools {

/// The samples of a channel, with the set and the source that they are read from.
class ChannelSamples {
 public:
  /// `from` must outlive it.
  ChannelSamples(const imager::VisibilitySource& from, const imager::StreamingOptions& options) : stream_(from, options) {}
  ChannelSamples(std::unique_ptr<const ms_io::MeasurementSet> set, std::unique_ptr<const imager::VisibilitySource> from,
                 const imager::StreamingOptions& options)
      : set_(std::move(set)), from_(std::move(from)), stream_(*from_, options) {}

  imager::StreamedVisibilities& stream() { return stream_; }

 private:
  std::unique_ptr<const ms_io::MeasurementSet> set_;      ///< that `from_` reads; null where it reads none
  std::unique_ptr<const imager::VisibilitySource> from_;  ///< null where another's
  imager::StreamedVisibilities stream_;
};

/// The visibilities of a run's channels. Visibilities of the one channel of the whole band stream from the sets; visibilities
/// of a cube's channels are held for some channels at a time, or read again by each, as ChannelBatches says.
class ChannelVisibilities {
 public:
  /// The visibilities of one channel. `set` is kept by reference.
  ChannelVisibilities(const ms_io::MeasurementSet& set, const imager::StreamingOptions& streaming)
      : set_(set), streaming_(streaming) {}
  /// The visibilities of a cube. All but `batches` are kept by reference.
  ChannelVisibilities(const ms_io::MeasurementSet& set, const imager::CubeSampling& sampling, const ChannelBatches& batches,
                      int threads)
      : set_(set), sampling_(&sampling), batches_(batches), threads_(threads) {}

  /// Calls visit(samples of a channel) for every channel of these batches of a cube, in passes of its own. Stages timed:
  /// "read", "planes".
  void look_through(const std::vector<imager::PlaneRange>& batches,
                    const std::function<void(const imager::VisibilitySource&)>& visit, ProgressLine& progress,
                    imager::StageTimes& times);
  /// Gets the channels of a batch ready, which take() then gives. Stages timed: "read", "planes".
  void begin(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times);
  /// The samples of a channel, once; null where there are none. Several threads may call it.
  std::unique_ptr<ChannelSamples> take(int channel);
  /// Ends a batch, and frees its visibilities.
  void end() { gathered_.reset(); }
  /// The work on a batch in words, "images 4 to 7 of 16".
  std::string work_on(const imager::PlaneRange& batch) const;

  /// True if each channel of a cube reads the sets itself; then count() is to be called with what it read.
  bool each_reads() const { return sampling_ != nullptr && batches_.read_again; }
  void count(const imager::SampleCounts& counts);
  /// The counts of all samples read so far; the channels count the used ones themselves.
  const imager::SampleCounts& counts() const { return counts_; }
  /// Usable samples among them that lie in no channel of the cube.
  std::uint64_t outside_channels() const { return outside_channels_; }

 private:
  ms_io::FrequencyRange frequencies_of(const imager::PlaneRange& range) const;
  std::unique_ptr<ms_io::MeasurementSet> part_of(const imager::PlaneRange& range) const;
  std::string numbers_of(const imager::PlaneRange& range) const;
  void gather(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times);

  const ms_io::MeasurementSet& set_;
  imager::StreamingOptions streaming_;
  const imager::CubeSampling* sampling_ = nullptr;  ///< null where there is one channel, of all
  ChannelBatches batches_;
  int threads_ = 1;
  std::optional<imager::GatheredPlanes> gathered_;  ///< of the batch at hand
  int first_ = 0;                                   ///< channel of that batch
  imager::SampleCounts counts_;
  std::uint64_t outside_channels_ = 0;
};

}  // namespace misfit::tools
