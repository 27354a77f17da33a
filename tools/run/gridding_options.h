#pragma once

#include <optional>

#include "imager/plan/gridding_choice.h"
#include "kernels/lookup_table.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// How samples are gridded: --kernel to --precision, and --gridder, which declare_scene() declares.
void declare_gridding(CLI::App& command, ImageOptions& options);

/// What needs neither the data nor the kernel's solution. Throws as check(const ImageOptions&) does.
void check_gridding(const ImageOptions& options);

/// Whether the options leave nothing of the kernel to choose: a file, or width and padding. Then no accuracy need be asked.
bool kernel_is_given(const ImageOptions& options);

/// The tables that --evaluation names, if it does.
std::optional<kernels::TableOptions> lookup_of(const ImageOptions& options);

imager::GriddingRequest gridding_request(const ImageOptions& options, int threads);

}  // namespace misfit::tools
