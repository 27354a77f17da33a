#pragma once

#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/plan/plan.h"
#include "ms_io/spectral_frame.h"
#include "tools/run/run_plan.h"

namespace misfit::tools {

/// Samples that a row gives to one channel, at most.
int samples_of_a_row(const imager::CubeSampling& sampling, const std::vector<ms_io::SpectralWindow>& windows);

/// How channels share the threads of a run.
struct ChannelWorkers {
  int count = 1;    ///< channels that are made at a time
  int threads = 1;  ///< for each of them
};

/// How a cube's channels get their visibilities, and are made.
struct ChannelBatches {
  int channels = 1;         ///< whose visibilities are gathered in one pass and held
  bool read_again = false;  ///< one channel's visibilities do not fit: each channel reads the set in every pass of its own
  ChannelWorkers workers;
  imager::MemoryUse memory;  ///< at the peak
  imager::Decision decision;
};

/// As many channels are made at a time as there are threads: that keeps all threads busy, while threads that share a channel
/// wait for each other. Fewer are made, and share the threads, where there are fewer channels, or where --memory, or half of
/// the machine's, has no room for the images and visibilities of so many; one at a time where channels read the set themselves.
/// As many channels are held as take half a GiB together and fit in that memory, at least one for each worker. Several ranks
/// take batches in turns: they hold so few channels that each rank has some turns, and all as many as the rank with the least
/// room. Called by all ranks. Throws std::invalid_argument that says how much memory is needed where --memory is less.
ChannelBatches plan_batches(const RunScene& scene, const RunPlan& plan);

/// The channels in batches of nearly the same size, whole numbers of channels for each worker but for the last.
std::vector<imager::PlaneRange> batches_of(int channels, const ChannelBatches& batches);

}  // namespace misfit::tools
