#pragma once

#include <string>
#include <vector>

#include "imager/image.h"

namespace misfit::tools {

/// How pixel values become shades: linear from `low` to `high`, or asinh(value / knee), which is linear below the knee and
/// logarithmic above it. Never empty: low < high.
struct Stretch {
  double low = 0;
  double high = 1;
  double knee = 0;      ///< 0 for the linear stretch
  bool sparse = false;  ///< most pixels are equal, as in a model of point sources

  double operator()(double value) const;
};

/// Limits from the noise, estimated as 1.4826 × the median absolute deviation: low is −3 noise (not below the smallest pixel),
/// high the largest pixel. Linear up to a peak of 30 noise, else asinh with the knee at 3 noise. A sparse image has no
/// noise: its knee is high / 300, and low −knee, so that 0 stays dark. Pixels that are not finite do not count.
Stretch choose_stretch(const imager::Image& image);

/// A mark of the colour bar.
struct Tick {
  double value = 0;
  std::string label;
};

/// Round values between `low` and `high`, six or so: evenly spaced for the linear stretch, else 0 and ±{1, 3} × 10^k.
std::vector<Tick> stretch_ticks(const Stretch& stretch);

/// `image` divided into square blocks, so that no side has more than `most` of them; each block keeps its finite pixel of
/// largest magnitude, so that point sources stay, or NaN where it has none. Block b begins at pixel b × block.
struct ReducedImage {
  imager::Image image;
  int block = 1;  ///< pixels a side
};
ReducedImage reduce(const imager::Image& image, int most);

}  // namespace misfit::tools
