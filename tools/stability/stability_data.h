#pragma once

#include <string>
#include <vector>

#include "imager/data/visibilities.h"
#include "tools/stability/stability_run.h"

namespace misfit::tools {

/// Places in the uv plane with weights, on which extremes are imposed: one channel whose metres are wavelengths, w = 0.
struct StabilityData {
  imager::VisibilityBlock block;  ///< without visibilities
  std::string description;        ///< "every 7th row of A.ms, 98 765 of 691 355 samples"

  /// The image's pixels are so small that the samples reach this part of 1/(2 cell).
  static constexpr double reach = 0.9;
  double cell_rad() const;
};

/// The array vla-a at a few hour angles, `samples` of them at most.
StabilityData made_data(std::size_t samples);

/// Usable samples of a MeasurementSet, in regular steps, so that there are `samples` at most. Throws std::runtime_error when it
/// cannot be read or has none.
StabilityData sampled_data(const std::string& vis, std::size_t samples);

inline constexpr int stability_pixels = 64;  ///< a side of the images

/// An image over these places, of a sky that they have observed: three sources on pixels, one of `peak_jy`, off the middle so
/// that its visibilities vary, and two of 0.5 and 0.3 Jy.
StabilityCase case_of(const std::string& name, imager::VisibilityBlock block, const imager::ImageGeometry& geometry,
                      double peak_jy = 1);

/// An image on the cell of the data.
StabilityCase case_of(const std::string& name, imager::VisibilityBlock block, const StabilityData& data, double peak_jy = 1);

}  // namespace misfit::tools
