#pragma once

#include "tools/run/image_run.h"

namespace misfit::tools {

/// run_image() with --specmode cube: one plane of frequency after the other, each as an image of its own.
bool run_cube(const ImageOptions& options, const RunCall& call, const imager::Ranks& ranks);

}  // namespace misfit::tools
