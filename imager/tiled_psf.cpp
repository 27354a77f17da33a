#include "imager/tiled_psf.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

constexpr int side = residual_tile_side;

int tiles(int pixels) {
  return (pixels + side - 1) / side;
}

/// Room for so many pixels in an odd number of cache lines: rows that lie a power of two apart push each other out of the
/// cache.
int row_length(int pixels) {
  constexpr int line = 16;
  return (pixels / line / 2 * 2 + (pixels / line % 2 == 0 ? 1 : 3)) * line;
}

}  // namespace

TiledPsf::TiledPsf(const Image& psf, int threads)
    : width_(psf.width),
      height_(psf.height),
      threads_(threads),
      tiles_u_(tiles(psf.width)),
      tiles_v_(tiles(psf.height)),
      columns_(row_length(psf.width)),
      pixel_(index(psf.height, 0, columns_)) {
  for (int r = 0; r < psf.height; ++r)
    std::transform(psf.row(r), psf.row(r) + psf.width, &pixel_[index(r, 0, columns_)],
                   [](double value) { return std::isnan(value) ? 0 : static_cast<float>(value); });
  bound_reach();
}

/// Pixels of tiles that lie d tiles apart are d · side − (side − 1) … d · side + (side − 1) pixels apart: within the spans of
/// `side` pixels that begin at (d − 1) · side and at d · side.
void TiledPsf::bound_reach() {
  const int spans_u = 2 * tiles_u_, spans_v = 2 * tiles_v_;
  std::vector<float> largest(index(spans_v, 0, spans_u));  // [span + tiles]
  const auto span = [](int pixel, int pixels, int tiles_along) { return (pixel - pixels / 2 + tiles_along * side) / side; };
  for (int r = 0; r < height_; ++r)
    for (int c = 0; c < width_; ++c) {
      float& value = largest[index(span(r, height_, tiles_v_), span(c, width_, tiles_u_), spans_u)];
      value = std::max(value, std::abs(*at(r, c)));
    }
  reach_.resize(index(spans_v - 1, 0, spans_u - 1));
  for (int v = 0; v + 1 < spans_v; ++v)
    for (int u = 0; u + 1 < spans_u; ++u)
      reach_[index(v, u, spans_u - 1)] = std::max({largest[index(v, u, spans_u)], largest[index(v, u + 1, spans_u)],
                                                   largest[index(v + 1, u, spans_u)], largest[index(v + 1, u + 1, spans_u)]});
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
