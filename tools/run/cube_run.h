#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/run/image_options.h"

namespace misfit::tools {

/// run_image() with --specmode cube: one plane of frequency after the other, each as an image of its own.
bool run_cube(const ImageOptions& options, const std::string& command_line, const nlohmann::json& option_values);

}  // namespace misfit::tools
