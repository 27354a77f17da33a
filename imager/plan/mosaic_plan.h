#pragma once

#include "imager/plan/gridding_plan.h"

namespace misfit::imager {

/// The plan of a request for a mosaic. Throws what plan_gridding() does, and std::invalid_argument where no pointing sees a
/// pixel of the image.
GriddingPlan plan_mosaic(const GriddingRequest& request);

/// Of all windows that are held at once.
TransformMemory memory_of(const WindowsPlan& windows, const GriddingRequest& request);

/// The transform of a mosaic's plan.
std::unique_ptr<Transform> make_mosaic_transform(const GriddingPlan& plan);

}  // namespace misfit::imager
