#pragma once

#include <string>
#include <vector>

#include "imager/data/image.h"

namespace misfit::tools {

/// The values that the shades of a picture are to show.
enum class Shades {
  brightness,  ///< sources on noise: from a little below the noise up to the brightest pixel
  about_zero,  ///< values of either sign, such as a residual: as far down as up, 0 in the middle
};

/// How pixel values become shades: linear from `low` to `high`, or asinh(value / knee), which is linear below the knee and
/// logarithmic above it. Never empty: low < high.
struct Stretch {
  double low = 0;
  double high = 1;
  double knee = 0;      ///< 0 for the linear stretch
  bool sparse = false;  ///< most pixels are equal, as in a model of point sources

  double operator()(double value) const;
};

/// Limits from the noise, estimated as 1.4826 × the median absolute deviation, and from the pixels that are finite.
/// For brightness: low is −3 noise (not below the smallest pixel), high the largest pixel; linear up to a peak of 30 noise,
/// else asinh with the knee at 3 noise. About zero: ± the largest magnitude, linear up to 8 noise; low is 0 where no pixel is
/// negative. A sparse image has no noise: its knee is the magnitude that nine tenths of its pixels that are not zero exceed,
/// but at least 1e-4 of the largest; for brightness its low is −knee, so that 0 stays dark.
Stretch choose_stretch(const imager::Image& image, Shades shades = Shades::brightness);

/// A mark of the colour bar.
struct Tick {
  double value = 0;
  std::string label;
};

/// Round values between `low` and `high`, up to a dozen: evenly spaced for the linear stretch, else 0 and ±{1, 3} × 10^k or
/// ±10^k.
std::vector<Tick> stretch_ticks(const Stretch& stretch);

}  // namespace misfit::tools
