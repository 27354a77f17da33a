#pragma once

#include <vector>

#include "imager/beams/voltage_pattern.h"

namespace misfit::imager {

/// A pattern on pixels about the axis, which need not be round, as seen on the sky where the zenith is north: a dish that turns
/// with the zenith turns it.
struct PatternGrid {
  struct Plane {
    double frequency_hz = 0;
    std::vector<double> voltage;  ///< [row][column], 1 on the axis
  };

  int width = 0, height = 0;
  double axis_column = 0, axis_row = 0;  ///< where the axis is, in pixels from the middle of the first
  double column_rad = 0, row_rad = 0;    ///< a pixel's size to the east and to the north: below 0 where columns run west
  bool of_sines = false;                 ///< whether pixels are evenly spaced in direction cosines; else in angles
  std::vector<Plane> planes;             ///< by frequency, at least one
};

/// The voltage at a frequency between two planes is interpolated linearly at the same angle times frequency; beyond the first
/// and the last plane, or with one plane, it scales with the wavelength. Between pixels it is a polynomial through four by
/// four. Beyond the pixels it is 0. Throws std::invalid_argument where sizes do not fit, or the axis lies outside the pixels.
Pattern image_pattern(PatternGrid grid);

}  // namespace misfit::imager
