#pragma once

#include <filesystem>

#include "tools/drawing/pictures.h"

namespace misfit::tools {

/// Writes what gnuplot needs to draw a picture into `folder`: "script", which leaves the picture in "png", and the data that it
/// reads. Throws std::runtime_error that names `folder` when they cannot be written.
void write_picture_script(const Picture& picture, const std::filesystem::path& folder);

}  // namespace misfit::tools
