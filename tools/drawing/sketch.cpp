#include "tools/drawing/sketch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/clean/mask.h"

namespace misfit::tools {
namespace {

/// The finite number of larger magnitude.
double stronger(double a, double b) {
  return std::isfinite(b) && !(std::abs(a) >= std::abs(b)) ? b : a;
}

}  // namespace

ReducedImage reduce(const imager::Image& image, int most) {
  const int block = std::max(1, (std::max(image.width, image.height) + most - 1) / most);
  if (block == 1) return {image, 1};
  imager::Image blocks((image.width + block - 1) / block, (image.height + block - 1) / block);
  std::fill(blocks.pixel.begin(), blocks.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      double& kept = blocks.at(row / block, column / block);
      kept = stronger(kept, image.at(row, column));
    }
  }
  return {std::move(blocks), block};
}

imager::Image spread_points(const imager::Image& image, int reach) {
  imager::Image spread = image;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (image.at(row, column) == 0) continue;
      for (int r = std::max(0, row - reach); r <= std::min(image.height - 1, row + reach); ++r)
        for (int c = std::max(0, column - reach); c <= std::min(image.width - 1, column + reach); ++c)
          spread.at(r, c) = stronger(spread.at(r, c), image.at(row, column));
    }
  }
  return spread;
}

Sketch sketch(const imager::Image& image, Shades shades, int screen_pixels) {
  constexpr double point = 5;  // screen pixels
  Sketch made{reduce(image, screen_pixels), choose_stretch(image, shades)};
  const double scale = 1.0 * screen_pixels / std::max(made.reduced.image.width, made.reduced.image.height);
  const int reach = static_cast<int>(std::ceil((point / scale - 1) / 2));
  if (made.stretch.sparse && reach > 0) made.reduced.image = spread_points(made.reduced.image, reach);
  return made;
}

std::vector<PixelSide> outline(const imager::Image& mask) {
  std::vector<PixelSide> sides;
  for (int row = 0; row < mask.height; ++row) {
    for (int column = 0; column < mask.width; ++column) {
      const bool inside = imager::mask_allows(mask.at(row, column));
      if (row > 0 && inside != imager::mask_allows(mask.at(row - 1, column))) sides.push_back({row, column, row, column + 1});
      if (column > 0 && inside != imager::mask_allows(mask.at(row, column - 1)))
        sides.push_back({row, column, row + 1, column});
    }
  }
  return sides;
}

}  // namespace misfit::tools
