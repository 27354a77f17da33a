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

/// Each pixel becomes the pixel of largest magnitude within `reach` rows and columns, so that a point is a square that can be
/// seen.
imager::Image spread_points(const imager::Image& image, int reach);

/// The part of an image that a picture needs: few enough pixels to keep at no cost, and the stretch that suits all pixels. It
/// outlasts the image.
struct Sketch {
  ReducedImage reduced;
  Stretch stretch;
};

/// The sketch for a picture whose longer side has `screen_pixels`; points of a sparse image cover five screen pixels or more.
Sketch sketch(const imager::Image& image, Shades shades, int screen_pixels);

/// A side of a pixel, from one of its corners to the next. Corner (row, column) is where that pixel begins, from the south and
/// east.
struct PixelSide {
  int from_row = 0;
  int from_column = 0;
  int to_row = 0;
  int to_column = 0;
};

/// The sides between pixels that `mask` allows and other pixels, see imager/clean/mask.h.
std::vector<PixelSide> outline(const imager::Image& mask);

}  // namespace misfit::tools
