#pragma once

#include <filesystem>

#include "tools/pictures.h"

namespace misfit::tools {

/// Writes what gnuplot needs to draw a picture into `folder`: "script", which leaves the picture in "png", "data", and
/// "mask". Throws
/// std::runtime_error that names the folder above when they cannot be written.
void write_picture_script(const Picture& picture, const std::filesystem::path& folder);

}  // namespace misfit::tools
