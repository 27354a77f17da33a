#pragma once

#include "tools/run/image_options.h"

namespace misfit::tools {

/// Throws std::invalid_argument where --memory, or else the machine's, does not hold what measuring takes: all visibilities,
/// those predicted, and the image's largest transform, of double precision at padding 2.
void check_scene_memory(const ImageOptions& scene);

}  // namespace misfit::tools
