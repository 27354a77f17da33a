#include "tools/formats/mask_placement.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/clean/mask.h"
#include "tools/formats/grid_offset.h"

namespace misfit::tools {
namespace {

using imager::ImageGeometry;
using imager::PixelPlace;
using imager::SkyGrid;

/// The distances, as a part of a pixel, up to which pixels of two grids count as the same, and from which on the nearest pixel
/// may be another.
constexpr double same_pixel = 0.01, nearest_pixel = 0.45;
/// If two pixels are equally near, the one to the right or above is taken: rounding does not choose.
constexpr double tie = 1e-6;

std::string size_text(int width, int height) {
  return std::to_string(width) + " × " + std::to_string(height);
}

}  // namespace

MaskPlacement::MaskPlacement(const imager::ImageReader& file, const std::string& path, const imager::ImageHeader& of)
    : image_(of.geometry), width_(file.header().geometry.width), height_(file.header().geometry.height) {
  const ImageGeometry& image = image_;
  if (!file.grid()) {
    if (width_ != image.width || height_ != image.height)
      throw std::runtime_error("mask " + path + " of " + size_text(width_, height_) +
                               " pixels does not say where it lies on the sky: expected the image's " +
                               size_text(image.width, image.height));
    sentence_ = "the mask " + path + " does not say where it lies on the sky: it is laid on the image pixel by pixel";
    return;
  }
  const GridBeside beside(file, "mask " + path, of);
  const SkyGrid& grid = beside.grid();
  map_ = beside.map();
  const GridOffset offset = offset_between(*map_, image);
  const bool on_pixels = offset.any && offset.most < nearest_pixel && std::abs(offset.right) < 1e9 && std::abs(offset.up) < 1e9;
  if (on_pixels) {
    map_.reset();
    right_ = static_cast<int>(offset.right);
    up_ = static_cast<int>(offset.up);
  }
  if (!covers_any())
    throw std::runtime_error("mask " + path + " lies elsewhere on the sky, and covers none of the image: it has " +
                             size_text(width_, height_) + " pixels of " + described(grid) + "; expected some of the image's, " +
                             size_text(image.width, image.height) + " of " + described(imager::grid_of(image)));
  if (!on_pixels || offset.most >= same_pixel)
    sentence_ = "the mask " + path + " has other pixels than the image, " + described(grid) +
                ": each pixel of the image takes the nearest of the mask, and is not cleaned where there is none";
  else if (right_ != 0 || up_ != 0 || width_ != image.width || height_ != image.height)
    sentence_ = "the mask " + path + " of " + size_text(width_, height_) + " pixels begins at column " +
                std::to_string(-right_) + ", row " + std::to_string(-up_) + " of the image, where its coordinates have it" +
                (covers_all() ? "" : ": pixels beside it are not cleaned");
  if (!beside.remark().empty()) sentence_ = beside.remark() + (sentence_.empty() ? "" : "; " + sentence_);
}

std::int64_t MaskPlacement::nearest(int row, int column) const {
  double right = column + right_, up = row + up_;
  if (map_) {
    const PixelPlace place = (*map_)(row, column);
    right = std::floor(place.column + 0.5 + tie);
    up = std::floor(place.row + 0.5 + tie);
  }
  if (!(right >= 0 && right < width_ && up >= 0 && up < height_)) return -1;
  return static_cast<std::int64_t>(up) * width_ + static_cast<std::int64_t>(right);
}

bool MaskPlacement::covers_any() const {
  const auto overlap = [](std::int64_t size, std::int64_t of_mask, std::int64_t shift) {
    return std::max<std::int64_t>(0, -shift) < std::min(size, of_mask - shift);
  };
  if (!map_) return overlap(image_.width, width_, right_) && overlap(image_.height, height_, up_);
  for (int row = 0; row < image_.height; ++row)
    for (int column = 0; column < image_.width; ++column)
      if (nearest(row, column) >= 0) return true;
  return false;
}

bool MaskPlacement::covers_all() const {
  return nearest(0, 0) >= 0 && nearest(image_.height - 1, image_.width - 1) >= 0;
}

imager::Image MaskPlacement::lay(const imager::ImageReader& file, const imager::PlaneIndex& at) const {
  imager::Image laid(image_.width, image_.height);  // first of numbers of pixels, which a double holds exactly
  std::int64_t first = std::int64_t{width_} * height_, last = 0;
  for (int row = 0; row < image_.height; ++row)
    for (int column = 0; column < image_.width; ++column) {
      const std::int64_t pixel = nearest(row, column);
      laid.at(row, column) = static_cast<double>(pixel);
      if (pixel < 0) continue;
      first = std::min(first, pixel);
      last = std::max(last, pixel);
    }
  const std::int64_t begin = first / width_, end = last / width_ + 1;
  const imager::Image mask = file.read_rows(at, static_cast<int>(begin), static_cast<int>(end - begin));
  for (double& pixel : laid.pixel) {
    const auto number = static_cast<std::int64_t>(pixel);
    pixel = number >= 0 && imager::mask_allows(mask.pixel[static_cast<std::size_t>(number - begin * width_)]) ? 1 : 0;
  }
  return laid;
}

}  // namespace misfit::tools
