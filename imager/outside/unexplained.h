#pragma once

#include <cmath>

#include "imager/data/geometry.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// The residual visibilities of a model within |u|, |v| ≤ 1/(4 cell): noise, and sources that the model lacks. Residuals
/// farther out also tell of sources between pixels. Samples in one cell of the uv plane see missing sources alike, and each has
/// its own noise, except that receivers may smooth noise over the channels of a row. So r is data − model, averaged over a
/// row's neighbouring channels within a cell. The mean of Re r_j r_k* over pairs within a cell is the square of the sources'
/// flux, and the scatter of r within cells is noise. Both are known to three standard deviations; without pairs all may be
/// either.
struct Unexplained {
  double rms_jy = 0;            ///< √(Σ w |r|² / Σ w)
  double sources_least_jy = 0;  ///< flux of sources that the model lacks, as if of one source
  double sources_most_jy = 0;   ///< never more than rms_jy
  double unit_noise_jy = 0;     ///< of each part of a sample of weight 1, at most

  /// The largest noise of a natural image with this Σ w.
  double image_noise_jy(double sum_of_weights) const { return unit_noise_jy / std::sqrt(sum_of_weights); }
};

/// Cells are 1/(4 · the field's width) wide and 1/(4 · its height) high: across a cell the phase of a source a whole field off
/// the middle turns by a quarter. Samples share cells within one block. Stages timed: "statistics", and those of
/// for_each_residual.
Unexplained unexplained_by(const Image& model, const VisibilitySource& source, const Transform& transform,
                           const ImageGeometry& field, const Context& context);

}  // namespace misfit::imager
