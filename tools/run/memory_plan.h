#pragma once

#include <functional>

#include "imager/data/ranks.h"
#include "imager/plan/gridding_plan.h"
#include "imager/plan/memory_use.h"
#include "imager/plan/plan.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// How a run keeps within its memory.
struct MemoryPlan {
  imager::StreamingOptions streaming;
  imager::MemoryUse peak;
  imager::Decision decision;
};

/// Limits a w axis to a quarter of `bytes` for its planes, and to an eighth for the samples that it gathers.
void limit_memory(double bytes, imager::GriddingRequest& request);

/// Plans the gridding of `request`. The planes of a w axis, or the windows of a mosaic, are transformed once for each batch of
/// samples. If one batch of `request`'s size is not enough, batches are as large as memory allows: --memory, or half of
/// `machine_bytes`, less all that `demand` counts for a plan.
imager::GriddingPlan plan_with_room(imager::GriddingRequest request,
                                    const std::function<imager::MemoryDemand(const imager::GriddingPlan&)>& demand,
                                    const ImageOptions& options, double machine_bytes);

/// The memory of this machine over the number of the run's processes on it, bytes.
double memory_of_a_process(const imager::Ranks& ranks);

/// Keeps the visibilities where --memory, or half of `machine_bytes`, allows it; else reads them again in every pass, and
/// less far ahead where that helps. Nothing of this changes a bit of the images. Throws std::invalid_argument that says how
/// much memory is needed when --memory, or `machine_bytes`, is less.
///
/// `least_with` gives the least bytes that a run takes when it is planned for a number of bytes, which may be more than that
/// number: the message names a memory that is enough. Without it the memory of `demand` counts.
MemoryPlan plan_memory(const imager::MemoryDemand& demand, const ImageOptions& options, double machine_bytes,
                       const std::function<double(double)>& least_with = {});

/// How visibilities stream where memory is scarcest.
inline const imager::StreamingOptions least_streaming{false, 0};

/// The peak and what it consists of, a line each.
std::string memory_table(const imager::MemoryUse& use);

}  // namespace misfit::tools
