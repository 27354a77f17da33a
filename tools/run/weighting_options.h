#pragma once

#include <string>
#include <vector>

#include "imager/plan/plan.h"
#include "imager/weighting/imaging_weights.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// Declares --weighting, --robust, --npixels and --uvtaper.
void declare_weighting(CLI::App& command, ImageOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected, also where an option has no effect.
void check_weighting(const ImageOptions& options);

imager::WeightingOptions weighting_options(const ImageOptions& options);

/// "Briggs, robust 0.5, tapered".
std::string weighting_text(const ImageOptions& options);

/// As they are typed, without those that have no effect.
std::vector<std::string> weighting_arguments(const ImageOptions& options);

/// What is known of the weights before the samples are read.
imager::Decision weighting_decision(const ImageOptions& options, const imager::ImageGeometry& geometry);

/// What they turned out to be, with the noise that they cost.
imager::Decision weights_decision(const imager::ImagingWeights& weights, const imager::WeightSums& sums);

}  // namespace misfit::tools
