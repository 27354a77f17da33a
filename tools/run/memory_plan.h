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

/// Lets a w axis take no more than parts of `bytes` for its planes and for the samples that it gathers.
void limit_memory(double bytes, imager::GriddingRequest& request);

/// Plans the gridding of `request`. A w axis transforms all planes whenever it has gathered as many samples as `request` says:
/// where it does so again and again, it gathers as many as the memory has room for that --memory, or half of `machine_bytes`,
/// leaves after all that `demand` makes of a plan.
imager::GriddingPlan plan_with_room(imager::GriddingRequest request,
                                    const std::function<imager::MemoryDemand(const imager::GriddingPlan&)>& demand,
                                    const ImageOptions& options, double machine_bytes);

/// What a machine has of memory, for one of the processes of a run that share it.
double memory_of_a_process(const imager::Ranks& ranks);

/// Keeps the visibilities where --memory, or half of `machine_bytes`, allows it; else reads them again in every pass, and
/// less far ahead where that helps. Nothing of this changes a bit of the images. Throws std::invalid_argument that says how
/// much memory is needed when --memory, or `machine_bytes`, is less.
///
/// `least_with` gives what a run takes at least when it is planned for so many bytes, which may be more than so many: the
/// memory that the message names is one that is enough. Without it that of `demand` counts.
MemoryPlan plan_memory(const imager::MemoryDemand& demand, const ImageOptions& options, double machine_bytes,
                       const std::function<double(double)>& least_with = {});

/// How visibilities stream where memory is scarcest.
inline const imager::StreamingOptions least_streaming{false, 0};

/// The peak and what it consists of, a line each.
std::string memory_table(const imager::MemoryUse& use);

}  // namespace misfit::tools
