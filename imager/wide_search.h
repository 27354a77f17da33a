#pragma once

#include "imager/imaging.h"
#include "imager/outside.h"
#include "imager/sidelobes.h"
#include "imager/unexplained.h"

namespace misfit::imager {

/// An image of a wider field about another, as coarse as short baselines make it.
struct WideField {
  ImageGeometry geometry;  ///< four times the image's sides
  double max_abs_w = 0;    ///< of the samples that this cell can represent, in wavelengths
};

/// Its cell is the image's times a power of two: 4 or, where it then has more than 1024 pixels a side, more; less where fewer
/// than a tenth of the usable samples would reach half as far in u and v as it can represent. One pass over the visibilities.
WideField wide_field(const VisibilitySource& source, const ImageGeometry& image);

/// What was found in it.
struct WideSearch {
  std::vector<Component> components;
  Sidelobes sidelobes;  ///< of its PSF, by its pixels
  double least_jy = 0;  ///< flux from which on they are told from noise, and from what a shallow CLEAN leaves of bright ones
  Unexplained unexplained;  ///< by the components, of the samples that its pixels can represent
  /// How high the sidelobes of sources may be that were not found, such as of those beyond the field: what is fainter may be
  /// one of them. Noise alone does not count, so far as samples share cells of the uv plane.
  double sidelobe_jy = 0;
};

/// Images the wider field with weights that fall off towards the edge of its grid, and finds its sources by Clark's CLEAN with
/// major cycles, down to five times the noise or a two-hundredth of the peak. Stages timed: "statistics", and those of
/// make_dirty_images and clean. Throws what they throw.
WideSearch search_wide_field(const VisibilitySource& source, const WideField& field, int threads, const Progress& progress,
                             StageTimes& times);

}  // namespace misfit::imager
