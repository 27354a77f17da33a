#pragma once

#include <vector>

#include "imager/data/image.h"
#include "tools/drawing/stretch.h"

namespace misfit::tools {

/// `image` divided into square blocks, so that no side has more than `most` of them; each block keeps its finite pixel of
/// largest magnitude, so that point sources stay, or NaN where it has none. Block b begins at pixel b × block.
struct ReducedImage {
  imager::Image image;
  int block = 1;  ///< pixels a side
};
ReducedImage reduce(const imager::Image& image, int most);

/// Each pixel becomes that of largest magnitude no more than `reach` rows and columns away, so that a point is a square that
/// can be seen.
imager::Image spread_points(const imager::Image& image, int reach);

/// What a picture shows of an image: so few pixels that to keep them costs nothing, and the stretch that all its pixels ask
/// for. It outlasts the image.
struct Sketch {
  ReducedImage reduced;
  Stretch stretch;
};

/// For a picture whose longer side has so many screen pixels; points of a sparse image cover five of them or more.
Sketch sketch(const imager::Image& image, Shades shades, int screen_pixels);

/// A side of a pixel, from one of its corners to the next. Corner (row, column) is where that pixel begins, from the south and
/// east.
struct PixelSide {
  int from_row = 0;
  int from_column = 0;
  int to_row = 0;
  int to_column = 0;
};

/// The sides that part pixels that `mask` allows from others, see imager/clean/mask.h.
std::vector<PixelSide> outline(const imager::Image& mask);

}  // namespace misfit::tools
