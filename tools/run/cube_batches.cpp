#include "tools/run/cube_batches.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "imager/cube/plane_gatherer.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

/// Of a plane while it waits; UVW is held once for all.
double gathered_bytes(const RunScene& scene, const RunPlan& plan) {
  return scene.samples * (sizeof(float) + 1.0 * plan.gridding.request.stokes * sizeof(std::complex<float>));
}

/// Of UVW and the order of rows, which planes share.
double shared_bytes(double rows) {
  return rows * (3 * sizeof(double) + sizeof(std::uint32_t));
}

/// Of the blocks that are read ahead, and at hand.
double in_flight_bytes(const RunScene& scene, const RunPlan& plan) {
  constexpr double blocks = 3;
  const double sample = 1.0 * plan.gridding.request.stokes * sizeof(std::complex<float>) + sizeof(float);
  const double row = 4 * sizeof(double) / std::max(1.0, scene.samples / static_cast<double>(scene.set.rows()));
  return blocks * static_cast<double>(scene.set.read_at_once()) * (sample + row);
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

CubeBatches plan_batches(const RunScene& scene, const RunPlan& plan) {
  constexpr double enough_bytes = gib / 2;  // each pass over the set reads little more than its planes' channels
  const double wanted = scene.options.memory_gib > 0 ? scene.options.memory_gib * gib : physical_memory_bytes() / 2;
  const double rows = static_cast<double>(scene.set.rows());
  const double plane = gathered_bytes(scene, plan), shared = shared_bytes(rows), flight = in_flight_bytes(scene, plan);
  // Planes wait while one is imaged, of whose visibilities the plan counts a copy.
  const double busy = shared + std::max(plan.memory.total(), plan.memory.process + flight);
  const double room = std::min(std::max(enough_bytes, plane), wanted - busy);
  CubeBatches batches;
  batches.read_again = !plan.streaming.keep || room < plane;
  batches.planes = batches.read_again ? 1 : static_cast<int>(std::clamp(room / plane, 1.0, 1.0 * scene.planes));
  const double streamed = std::min(1.0, static_cast<double>(imager::rows_gathered_at_once) / rows);
  batches.memory_bytes = busy + (batches.read_again ? streamed : batches.planes) * plane;
  const auto passes = batches_of(scene.planes, batches.planes).size();
  batches.decision = {"planes",
                      std::to_string(scene.planes) + ", of which " + std::to_string(batches.planes) +
                          (batches.planes == 1 ? " is" : " are") + " held at a time",
                      batches.read_again ? "there is no room for the visibilities of one: it reads the set in every pass"
                                         : "the visibilities of one take " + significant(plane / gib, 2) +
                                               " GiB at most; the set is read in " + std::to_string(passes) +
                                               (passes == 1 ? " pass" : " passes")};
  return batches;
}

std::vector<imager::PlaneRange> batches_of(int planes, int most) {
  const int count = (planes + most - 1) / most;
  std::vector<imager::PlaneRange> ranges;
  for (int b = 0; b < count; ++b) {
    const int first = static_cast<int>(static_cast<long long>(planes) * b / count);
    ranges.push_back({first, static_cast<int>(static_cast<long long>(planes) * (b + 1) / count) - first});
  }
  return ranges;
}

}  // namespace misfit::tools
