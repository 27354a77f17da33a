#include "tools/run/memory_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/base/memory.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string gib_text(double bytes) {
  return significant(bytes / gib, 3) + " GiB";
}

/// A memory in hundredths of a GiB that is enough, also for the run that is planned for it.
std::string enough_text(double bytes, const std::function<double(double)>& least_with) {
  double hundredths = std::ceil(bytes / gib * 100);
  for (int tries = 0; least_with && tries < 20; ++tries) {
    const double needed = std::ceil(least_with(hundredths / 100 * gib) / gib * 100);
    if (needed <= hundredths) break;
    hundredths = needed;
  }
  return significant(hundredths / 100, 6) + " GiB";
}

[[noreturn]] void refuse(const ImageOptions& o, double needed_bytes, double machine_bytes,
                         const std::function<double(double)>& least_with) {
  const std::string size = std::to_string(o.imsize.front()) + " × " + std::to_string(o.imsize.back());
  if (o.memory_gib > 0)
    throw std::invalid_argument("--memory " + significant(o.memory_gib, 6) + ": expected at least " +
                                enough_text(needed_bytes, least_with) + ", which grids and images of " + size +
                                " pixels need, or fewer pixels");
  throw std::invalid_argument("--imsize " + std::to_string(o.imsize.front()) + " " + std::to_string(o.imsize.back()) +
                              ": expected an image that fits this machine's " + gib_text(machine_bytes) + "; this one needs " +
                              gib_text(needed_bytes));
}

double wanted_bytes(const ImageOptions& o, double machine_bytes) {
  return o.memory_gib > 0 ? o.memory_gib * gib : machine_bytes / 2;
}

/// The fastest streaming that fits in `wanted`, or the one that takes least.
MemoryPlan streaming_within(double wanted, const imager::MemoryDemand& demand) {
  MemoryPlan plan;
  for (const imager::StreamingOptions streaming :
       {imager::StreamingOptions{true, 2}, {false, 2}, {false, 1}, least_streaming}) {
    plan.streaming = streaming;
    plan.peak = imager::peak_memory(demand, streaming);
    if (plan.peak.total() <= wanted) break;
  }
  return plan;
}

}  // namespace

void limit_memory(double bytes, imager::GriddingRequest& o) {
  o.stack_bytes = std::min(o.stack_bytes, static_cast<std::size_t>(bytes / 4));
  o.samples_at_once = std::min(o.samples_at_once, static_cast<std::size_t>(bytes / 8 / imager::wide_bytes_a_sample));
}

imager::GriddingPlan plan_with_room(imager::GriddingRequest request,
                                    const std::function<imager::MemoryDemand(const imager::GriddingPlan&)>& demand,
                                    const ImageOptions& o, double machine_bytes) {
  imager::GriddingPlan plan = imager::plan_gridding(request);
  const double wanted = wanted_bytes(o, machine_bytes);
  const imager::MemoryDemand first = demand(plan);
  const double left = wanted - streaming_within(wanted, first).peak.total();
  if (!(plan.options.has_w_axis() || plan.windows) || first.samples <= static_cast<double>(request.samples_at_once) ||
      left <= 0)
    return plan;
  const double sample_bytes = imager::wide_bytes_a_sample + (imager::wide_bytes_a_value + 16.0) * std::max(1, request.stokes);
  const std::size_t at_once = request.samples_at_once;
  for (double room = left; room > left / 4; room /= 1.5) {
    request.samples_at_once = at_once + static_cast<std::size_t>(room / sample_bytes);
    imager::GriddingPlan roomy = imager::plan_gridding(request);
    if (streaming_within(wanted, demand(roomy)).peak.total() <= wanted) return roomy;
  }
  return plan;
}

double memory_of_a_process(const imager::Ranks& ranks) {
  return physical_memory_bytes() / ranks.on_this_machine();
}

MemoryPlan plan_memory(const imager::MemoryDemand& demand, const ImageOptions& o, double machine_bytes,
                       const std::function<double(double)>& least_with) {
  const double wanted = wanted_bytes(o, machine_bytes);
  const double limit = o.memory_gib > 0 ? wanted : machine_bytes;
  const std::string within =
      o.memory_gib > 0 ? gib_text(wanted) + " asked" : "half of the machine's " + gib_text(machine_bytes);
  MemoryPlan plan = streaming_within(wanted, demand);
  if (plan.peak.total() > limit) refuse(o, plan.peak.total(), machine_bytes, least_with);
  const double if_kept = imager::peak_memory(demand, {true, 2}).total();
  plan.decision = {"visibilities", plan.streaming.keep ? "kept in memory" : "read again in every pass",
                   "kept, they bring the run's memory to " + gib_text(if_kept) + ", against " + within};
  return plan;
}

std::string memory_table(const imager::MemoryUse& use) {
  std::string table = "memory: " + gib_text(use.total()) + " at most, while " + use.when + "\n";
  for (const auto& [name, bytes] : {std::pair{"program", use.process},
                                    {"visibilities kept", use.visibilities},
                                    {"blocks in flight", use.blocks},
                                    {"grids", use.grids},
                                    {"FFT buffers", use.fft},
                                    {"images", use.images}})
    table += std::string("  ") + name + ": " + gib_text(bytes) + "\n";
  return table;
}

}  // namespace misfit::tools
