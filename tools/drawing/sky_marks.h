#pragma once

#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/geometry.h"
#include "tools/base/numbers.h"

namespace misfit::tools {

/// The offsets from the phase centre that an image covers, borders of its outermost pixels included, in `unit`.
struct SkyFrame {
  ScaledUnit unit;
  double east = 0;
  double west = 0;
  double south = 0;
  double north = 0;

  double width() const { return east - west; }
  double height() const { return north - south; }
};
SkyFrame sky_frame(const imager::ImageGeometry& geometry);

/// An offset, rad.
struct SkyOffset {
  double east = 0;
  double north = 0;
};

/// Half of the smallest upright box around a beam's ellipse at half maximum.
SkyOffset beam_reach(const imager::Beam& beam);

/// The beam's ellipse at half maximum about 0, as a closed polygon that begins at the tip which the position angle names.
std::vector<SkyOffset> beam_ellipse(const imager::Beam& beam);

/// The largest round angle not above `longest_rad`: 1, 2, 5, 10, 20 or 30 arcsec or arcmin; above them 1, 2 or 5 × 10^k deg,
/// below them mas.
struct ScaleBar {
  double length_rad = 0;
  std::string label;  ///< e.g. "20 arcsec"
};
ScaleBar scale_bar(double longest_rad);

}  // namespace misfit::tools
