#pragma once

#include "imager/plan/gridding_plan.h"

namespace misfit::imager {

/// The plan of a request for a mosaic. Throws what plan_gridding() does, and std::invalid_argument where no pointing sees a
/// pixel of the image.
GriddingPlan plan_mosaic(const GriddingRequest& request);

/// Sets how many windows are worked on at a time, and by how many threads each.
void share_threads(WindowsPlan& windows, int threads);

/// Seconds of a core that a pass takes which makes so many images, or as many as were planned, by the fixed constants of
/// CostModel.
double mosaic_seconds(const WindowsPlan& windows, int images);

/// The memory that a mosaic's transform takes, however many threads share its windows.
TransformMemory mosaic_memory(const GriddingPlan& plan);

/// The transform of a mosaic's plan.
std::unique_ptr<Transform> make_mosaic_transform(const GriddingPlan& plan);

}  // namespace misfit::imager
