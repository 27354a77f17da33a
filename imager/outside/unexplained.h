#pragma once

#include <cmath>

#include "imager/data/geometry.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// What a model leaves of visibilities within |u|, |v| ≤ 1/(4 cell): noise, and sources that it lacks. Those farther out tell
/// of sources between pixels, too. Samples in one cell of the uv plane see missing sources alike, and noise each its own, but
/// for the channels of a row, of which receivers may smooth noise: r is data − model, averaged over a row's neighbouring
/// channels within a cell. The mean of Re r_j r_k* over pairs within a cell is the square of the sources' flux, and what r
/// scatters by within cells is noise. Both are known to three standard deviations; without pairs all may be either.
struct Unexplained {
  double rms_jy = 0;            ///< √(Σ w |r|² / Σ w)
  double sources_least_jy = 0;  ///< flux of sources that the model lacks, as of one of them
  double sources_most_jy = 0;   ///< never more than rms_jy
  double unit_noise_jy = 0;     ///< of each part of a sample of weight 1, at most

  /// The most that the noise of a natural image with this Σ w can be.
  double image_noise_jy(double sum_of_weights) const { return unit_noise_jy / std::sqrt(sum_of_weights); }
};

/// Cells are 1/(4 · the field's width) wide and 1/(4 · its height) high: over one of them the phase of a source a whole field
/// off the middle turns by a quarter. Cells are those of one block. Stages timed: "statistics", and those of for_each_residual.
Unexplained unexplained_by(const Image& model, const VisibilitySource& source, const Transform& transform,
                           const ImageGeometry& field, const Context& context);

}  // namespace misfit::imager
