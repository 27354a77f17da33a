#pragma once

#include <filesystem>

#include "imager/streaming/uv_coverage.h"

namespace misfit::tools {

/// Writes what gnuplot needs to draw how densely samples fill the uv plane into `folder`, as write_picture_script() does: u to
/// the right, v up, in λ, kλ, Mλ or Gλ, as far as there are samples; counts on a log scale, empty cells white. Where samples
/// are few their cells are drawn larger. Throws std::runtime_error that names `folder` when it cannot be written.
void write_uv_script(const imager::UvCoverage& coverage, const std::filesystem::path& folder);

}  // namespace misfit::tools
