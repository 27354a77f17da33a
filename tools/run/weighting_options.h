#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "imager/data/spectral_axis.h"
#include "imager/plan/plan.h"
#include "imager/weighting/imaging_weights.h"
#include "tools/run/cube_options.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// How samples are weighed, as typed.
struct TypedWeighting {
  std::string scheme = "natural";
  double robust = 0.5;          ///< of Briggs' schemes
  std::string noise = "1.0Jy";  ///< of briggsabs
  int npixels = 0;              ///< of superuniform; 0 = 6
  double rank_filter = 0;       ///< its level; 0 = none
  int rank_filter_size = 16;    ///< cells across its box
  bool mosweight = true;        ///< each pointing's weights follow from its own samples; or from those of all
  std::string uvtaper;          ///< here and below, empty = none
  std::string minuv_l;
  std::string maxuv_l;
  std::string taper_tukey;        ///< width of the edge at maxuv_l
  std::string taper_inner_tukey;  ///< width of the edge at minuv_l, or at 0
};

void declare(CLI::App& command, TypedWeighting& options);

/// Throws std::invalid_argument that names the option, its value and what was expected, also where an option has no effect.
void check(const TypedWeighting& options, const CubeOptions& cube);

/// The weighting of an image of so many pointings: more than one in a mosaic, whose blocks then tell the sights of their rows.
imager::WeightingOptions weighting_options(const TypedWeighting& options, std::size_t pointings = 1);
/// The weighting of the planes of a cube, whose bandwidth may matter.
imager::WeightingOptions weighting_options(const TypedWeighting& options, const imager::SpectralAxis& cube,
                                           std::size_t pointings = 1);

/// "Briggs, robust 0.5, tapered".
std::string weighting_text(const TypedWeighting& options);

/// The options as they are typed, without those that have no effect.
std::vector<std::string> weighting_arguments(const TypedWeighting& options);

/// Throws std::runtime_error that names the taper and the limits where they leave no weight that counts, which `sums` over so
/// many samples tell; `of` says which samples: "", or " of plane 12".
void require_weight(const TypedWeighting& options, const imager::WeightSums& sums, std::uint64_t samples,
                    const std::string& of = "");

/// The decision on the weights before the samples are read.
imager::Decision weighting_decision(const TypedWeighting& options, const imager::ImageGeometry& geometry,
                                    std::size_t pointings = 1);

/// The decision on the weights as they turned out, with the noise that they cost.
imager::Decision weights_decision(const imager::ImagingWeights& weights, const imager::WeightSums& sums);

}  // namespace misfit::tools
