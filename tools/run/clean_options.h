#pragma once

#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// CLEAN: its deconvolver and depth, masks, what it begins with and leaves.
void declare_clean(CLI::App& command, ImageOptions& options);

/// Throws as check(const ImageOptions&) does.
void check_clean(const ImageOptions& options);

imager::CleanOptions clean_options(const ImageOptions& options, int threads);
imager::DeconvolverChoice deconvolver_choice(const ImageOptions& options, int threads);

}  // namespace misfit::tools
