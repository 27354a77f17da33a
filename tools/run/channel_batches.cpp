#include "tools/run/channel_batches.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "imager/cube/plane_gatherer.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/run/memory_plan.h"

namespace misfit::tools {
namespace {

/// The bytes that a channel takes while it waits, without UVW, which is held once for all.
double gathered_bytes(const RunScene& scene, const RunPlan& plan) {
  return scene.samples * (sizeof(float) + 1.0 * plan.gridding.request.stokes * sizeof(std::complex<float>));
}

/// The bytes of UVW and of the order of rows, which channels share.
double shared_bytes(double rows) {
  return rows * (3 * sizeof(double) + sizeof(std::uint32_t));
}

/// The bytes of the blocks that are read ahead, and at hand.
double in_flight_bytes(const RunScene& scene, const RunPlan& plan) {
  constexpr double blocks = 3;
  const double sample = 1.0 * plan.gridding.request.stokes * sizeof(std::complex<float>) + sizeof(float);
  const double row = 4 * sizeof(double) / std::max(1.0, scene.samples / static_cast<double>(scene.set.rows()));
  return blocks * static_cast<double>(scene.set.read_at_once()) * (sample + row);
}

/// The memory while `workers` channels are imaged at a time, beside `waiting` bytes: each channel has a copy of its
/// visibilities, grids and images, and its thread an allocator's memory; FFT buffers are counted with the threads. An image on
/// its way to another rank exists as an image, as a message, and as MPI's copy.
imager::MemoryUse while_imaging(imager::MemoryUse one, double waiting, int workers, double message_bytes) {
  constexpr double allocator_bytes = 56e6;  // see imager::peak_memory()
  one.process += (workers - 1) * allocator_bytes;
  for (double* bytes : {&one.visibilities, &one.blocks, &one.grids, &one.images}) *bytes *= workers;
  one.visibilities += waiting;
  one.images += message_bytes;
  return one;
}

/// The most channels in a batch so that ranks, which take batches in turns until there are none, end at about the same time.
int channels_dealt_out(const RunScene& scene) {
  constexpr int turns = 3;
  return scene.ranks.alone() ? scene.channels
                             : (scene.channels + turns * scene.ranks.size() - 1) / (turns * scene.ranks.size());
}

/// Makes all ranks hold as many channels as the one with the least room, and make no more at a time.
void agree(ChannelBatches& batches, const RunScene& scene) {
  batches.channels = -static_cast<int>(imager::largest_of(scene.ranks, -batches.channels));
  batches.read_again = imager::any_of(scene.ranks, batches.read_again);
  batches.workers.count = batches.read_again ? 1 : std::min(batches.workers.count, batches.channels);
  batches.workers.threads = scene.threads / batches.workers.count;
}

/// The larger of both.
imager::MemoryUse peak_of(const imager::MemoryUse& one, const imager::MemoryUse& other) {
  return one.total() < other.total() ? other : one;
}

imager::Decision decision_on(const ChannelBatches& batches, const RunScene& scene, double channel_bytes) {
  const auto held = std::to_string(batches.channels) + (batches.channels == 1 ? " is" : " are") + " held";
  const int at_once = batches.workers.count;
  const auto passes = batches_of(scene.channels, batches).size();
  return {"planes",
          std::to_string(scene.channels) + ", of which " + held +
              (at_once == 1 ? " at a time" : " and " + std::to_string(at_once) + " imaged at a time"),
          batches.read_again ? "there is no room for the visibilities of one: it reads the set in every pass"
                             : "the visibilities of one take " + significant(channel_bytes / gib, 2) +
                                   " GiB at most; the set is read in " + std::to_string(passes) +
                                   (passes == 1 ? " pass" : " passes") + (scene.ranks.alone() ? "" : " of all ranks")};
}

}  // namespace

int samples_of_a_row(const imager::CubeSampling& sampling, const std::vector<ms_io::SpectralWindow>& windows) {
  std::size_t most = 1;
  for (const ms_io::SpectralWindow& window : windows)
    for (const imager::PlaneChannels& plane :
         imager::map_channels(sampling, {0, sampling.axis.channels}, {window.frequency_hz, window.channel_width_hz}, 1).planes)
      most = std::max(most, plane.tap.size());
  return static_cast<int>(most);
}

ChannelBatches plan_batches(const RunScene& scene, const RunPlan& plan) {
  constexpr double enough_bytes = gib / 2;  // each pass over the set reads little more than its channels need
  const double wanted = scene.options.memory_gib > 0 ? scene.options.memory_gib * gib : memory_of_a_process(scene.ranks) / 2;
  const double rows = static_cast<double>(scene.set.rows());
  const double channel = gathered_bytes(scene, plan), flight = in_flight_bytes(scene, plan);
  const double message = scene.ranks.alone() ? 0 : 3 * sizeof(double) * static_cast<double>(scene.geometry.pixels());
  const auto memory = [&](double waiting, int workers) {
    waiting += shared_bytes(rows);
    return peak_of(while_imaging(plan.memory, waiting, workers, message),
                   {"planes are gathered", plan.memory.process, waiting, flight, 0, 0, 0});
  };
  const auto room = [&](int workers) { return wanted - memory(0, workers).total(); };
  ChannelBatches batches;
  batches.read_again = !plan.streaming.keep || room(1) < channel;
  int& workers = batches.workers.count;
  if (!batches.read_again)
    for (workers = scene.workers; workers > 1 && room(workers) < workers * channel;) --workers;
  if (!batches.read_again) {
    const double most = std::max(workers, channels_dealt_out(scene));
    const double held = std::clamp(std::min(enough_bytes, room(workers)) / channel, 1.0 * workers, most);
    batches.channels = static_cast<int>(held);
    if (batches.channels < scene.channels) batches.channels -= batches.channels % workers;
  }
  agree(batches, scene);
  // A channel that reads the set holds the rows that are gridded together, and the blocks that are made of them.
  const double streamed = 2 * std::min(1.0, static_cast<double>(imager::samples_gathered_at_once) / scene.samples);
  batches.memory = memory((batches.read_again ? streamed : batches.channels) * channel, workers);
  if (scene.options.memory_gib > 0 && batches.memory.total() > wanted)
    throw std::invalid_argument("--memory " + significant(scene.options.memory_gib, 6) + ": expected at least " +
                                significant(std::ceil(batches.memory.total() / gib * 100) / 100, 6) +
                                " GiB, which a plane of the cube and the samples on their way to it need");
  batches.decision = decision_on(batches, scene, channel);
  return batches;
}

std::vector<imager::PlaneRange> batches_of(int channels, const ChannelBatches& batches) {
  if (batches.channels >= channels) return {{0, channels}};
  const int at_once = batches.workers.count, most = batches.channels / at_once;
  const int rounds = (channels + at_once - 1) / at_once, count = (rounds + most - 1) / most;
  const auto first = [&](int b) {
    return std::min(channels, at_once * static_cast<int>(static_cast<long long>(rounds) * b / count));
  };
  std::vector<imager::PlaneRange> ranges;
  for (int b = 0; b < count; ++b) ranges.push_back({first(b), first(b + 1) - first(b)});
  return ranges;
}

}  // namespace misfit::tools
