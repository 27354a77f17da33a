#include "imager/clean/tiled_psf.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

int tiles(int pixels) {
  return (pixels + residual_tile_side - 1) / residual_tile_side;
}

std::size_t index(int row, int column, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// Room for so many pixels in an odd number of cache lines: rows that lie a power of two apart push each other out of the
/// cache.
int row_length(int pixels) {
  constexpr int line = 16;
  return (pixels / line / 2 * 2 + (pixels / line % 2 == 0 ? 1 : 3)) * line;
}

/// The largest in squares of so many by so many.
std::vector<float> largest_in_squares(const std::vector<float>& value, int rows, int columns, int side) {
  std::vector<float> largest(index(rows / side, 0, columns / side));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      float& of_square = largest[index(r / side, c / side, columns / side)];
      of_square = std::max(of_square, value[index(r, c, columns)]);
    }
  return largest;
}

}  // namespace

/// Pixels of squares that lie d squares apart are d · side − (side − 1) … d · side + (side − 1) pixels apart: within the spans
/// of `side` pixels that begin at (d − 1) · side and at d · side.
Reach::Reach(int rows, int columns, const std::vector<float>& largest) : rows_(rows), columns_(columns) {
  const int spans = 2 * columns;
  value_.reserve(largest.size());
  for (int v = 0; v + 1 < 2 * rows; ++v)
    for (int u = 0; u + 1 < spans; ++u)
      value_.push_back(std::max({largest[index(v, u, spans)], largest[index(v, u + 1, spans)], largest[index(v + 1, u, spans)],
                                 largest[index(v + 1, u + 1, spans)]}));
}

TiledPsf::TiledPsf(const Image& psf, int threads)
    : width_(psf.width),
      height_(psf.height),
      threads_(threads),
      tiles_u_(tiles(psf.width)),
      tiles_v_(tiles(psf.height)),
      columns_(row_length(psf.width + 2 * margin)) {
  const std::size_t pixels = index(psf.height + 2 * margin, 0, columns_);
  pixel_.reserve(pixels);
  std::fill_n(pixel_.data(), pixels, 0.0F);
  parallel_for(static_cast<std::size_t>(height_), threads, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    std::transform(psf.row(r), psf.row(r) + psf.width, &pixel_.data()[index(r + margin, margin, columns_)],
                   [](double value) { return std::isnan(value) ? 0 : static_cast<float>(value); });
  });
  constexpr int along = blocks_along_tile;
  const std::vector<float> in_blocks = largest_in_blocks();
  between_blocks_ = std::make_unique<Reach>(tiles_v_ * along, tiles_u_ * along, in_blocks);
  between_tiles_ = std::make_unique<Reach>(tiles_v_, tiles_u_,
                                           largest_in_squares(in_blocks, 2 * tiles_v_ * along, 2 * tiles_u_ * along, along));
}

/// The largest |PSF| in blocks counted from the middle pixel, which is the first of that in the middle of
/// [2 tiles_v · blocks_along_tile][2 tiles_u · blocks_along_tile].
std::vector<float> TiledPsf::largest_in_blocks() const {
  constexpr int side = residual_block_side;
  const int blocks_u = tiles_u_ * blocks_along_tile, blocks_v = tiles_v_ * blocks_along_tile;
  std::vector<float> largest(index(2 * blocks_v, 0, 2 * blocks_u));
  parallel_for(2 * static_cast<std::size_t>(blocks_v), threads_, [&](std::size_t v) {
    const int first = (static_cast<int>(v) - blocks_v) * side + height_ / 2;
    for (int r = std::max(0, first); r < std::min(height_, first + side); ++r)
      for (int c = 0; c < width_; ++c) {
        float& value = largest[index(static_cast<int>(v), (c - width_ / 2 + blocks_u * side) / side, 2 * blocks_u)];
        value = std::max(value, std::abs(*at(r, c)));
      }
  });
  return largest;
}

const Convolution<float>& TiledPsf::convolution() const {
  std::call_once(convolution_made_, [this] {
    Image psf(width_, height_);
    for (int r = 0; r < height_; ++r) std::copy_n(at(r, 0), width_, psf.row(r));
    convolution_ = std::make_unique<Convolution<float>>(psf, threads_);
  });
  return *convolution_;
}

}  // namespace misfit::imager
