#include "imager/tiled_residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/parallel.h"
#include "imager/tiled_residual_loops.h"

namespace misfit::imager {
namespace {

constexpr int side = residual_tile_side;
constexpr std::size_t tile_pixels = std::size_t{side} * side;
constexpr float nothing = -std::numeric_limits<float>::infinity();

std::size_t at(int row, int column, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// A span of the PSF's rows or columns as a tile's pixels see them.
struct Overlap {
  int first;  ///< pixel of the tile
  int end;
  int shift;  ///< of the PSF's pixel against the tile's

  bool whole() const { return first == 0 && end == side; }
};
Overlap overlap(int tile, int component, int pixels) {
  const int shift = tile * side - component + pixels / 2;
  return {std::max(0, -shift), std::min(side, pixels - shift), shift};
}

}  // namespace

TiledResidual::TiledResidual(const Image& residual, const TiledPsf& psf, int threads)
    : residual_(residual),
      psf_(psf),
      threads_(threads),
      tiles_u_(psf.tiles_u()),
      tiles_v_(psf.tiles_v()),
      pixel_(at(tiles_v_, 0, tiles_u_) * tile_pixels, std::numeric_limits<float>::quiet_NaN()),
      taken_(at(tiles_v_, 0, tiles_u_)),
      bright_(taken_.size()),
      rest_bound_(taken_.size()),
      bound_(taken_.size()),
      row_bound_(static_cast<std::size_t>(tiles_v_)) {
  load(residual);
}

float* TiledResidual::tile(std::size_t index) {
  return pixel_.data() + index * tile_pixels;
}

/// Takes over an image from which all components have been taken.
void TiledResidual::load(const Image& image) {
  parallel_for(static_cast<std::size_t>(tiles_v_), threads_, [&](std::size_t v) {
    const int first = static_cast<int>(v) * side;
    for (int r = first; r < std::min(image.height, first + side); ++r)
      for (int u = 0; u < tiles_u_; ++u)
        std::copy(image.row(r) + u * side, image.row(r) + std::min(image.width, (u + 1) * side),
                  tile(at(static_cast<int>(v), u, tiles_u_)) + (r - first) * side);
    for (int u = 0; u < tiles_u_; ++u) {
      const std::size_t index = at(static_cast<int>(v), u, tiles_u_);
      taken_[index] = component_.size();
      bound_[index] = subtract_and_peak(tile(index), nullptr, 0, 0);
      choose_bright(index);
    }
    row_bound_[v] = row_bound(v);
  });
}

float TiledResidual::row_bound(std::size_t tile_row) const {
  const auto begin = bound_.begin() + static_cast<std::ptrdiff_t>(tile_row) * tiles_u_;
  return *std::max_element(begin, begin + tiles_u_);
}

void TiledResidual::subtract(int row, int column, float factor) {
  component_.push_back({row, column, factor});
  const int tile_v = row / side, tile_u = column / side;
  for (int v = 0; v < tiles_v_; ++v) {
    const float* const reach = psf_.reach(v - tile_v, -tile_u);
    const std::size_t first = at(v, 0, tiles_u_);
    raise_bounds(&rest_bound_[first], reach, tiles_u_, std::abs(factor));
    row_bound_[static_cast<std::size_t>(v)] = raise_bounds(&bound_[first], reach, tiles_u_, std::abs(factor));
  }
}

Peak TiledResidual::peak() {
  while (refresh_tiles_at_peak()) {
  }
  const float value = *std::max_element(row_bound_.begin(), row_bound_.end());
  if (value == nothing) return {};
  Peak first{residual_.height, 0, 0};
  for (int v = 0; v < tiles_v_; ++v) {
    if (row_bound_[static_cast<std::size_t>(v)] != value) continue;
    for (int u = 0; u < tiles_u_; ++u) {
      const std::size_t index = at(v, u, tiles_u_);
      if (bound_[index] != value) continue;
      const Bright& bright = bright_[index];
      const auto is_peak = [value](float x) { return std::abs(x) == value; };
      const auto found = std::find_if(bright.value.begin(), bright.value.end(), is_peak) - bright.value.begin();
      const int place = bright.place[static_cast<std::size_t>(found)];
      const int row = v * side + place / side;
      if (row < first.row) first = {row, u * side + place % side, double{bright.value[static_cast<std::size_t>(found)]}};
    }
    return first;  // other rows of tiles lie below
  }
  return first;
}

bool TiledResidual::certain(std::size_t index) const {
  return bound_[index] == nothing || (bright_[index].taken == component_.size() && bound_[index] == bright_[index].peak);
}

/// Looks at the tiles that might hold the peak. Returns whether there were any that had to be looked at.
bool TiledResidual::refresh_tiles_at_peak() {
  const float highest = *std::max_element(row_bound_.begin(), row_bound_.end());
  bool any = false;
  for (std::size_t v = 0; v < row_bound_.size(); ++v) {
    if (row_bound_[v] != highest) continue;
    for (std::size_t i = v * static_cast<std::size_t>(tiles_u_); i < (v + 1) * static_cast<std::size_t>(tiles_u_); ++i) {
      if (bound_[i] != highest || certain(i)) continue;
      any = true;
      if (bright_[i].taken < component_.size()) {
        refresh_bright(i);
        continue;
      }
      if (convolution_is_cheaper(highest)) {
        refresh_all();
        return true;
      }
      refresh(i);
    }
    row_bound_[v] = row_bound(v);
  }
  return any;
}

/// Whether one convolution costs less than to take components, one by one, off the tiles that must be looked at soon.
bool TiledResidual::convolution_is_cheaper(float highest) const {
  constexpr float soon = 0.6F;
  constexpr double pixels_a_patch = 5;  // of a convolution, that take as long as a component's part in a tile; measured
  double patches = 0;
  for (std::size_t i = 0; i < bound_.size(); ++i)
    if (rest_bound_[i] >= soon * highest) patches += static_cast<double>(component_.size() - taken_[i]);
  return patches * pixels_a_patch > static_cast<double>(residual_.pixel.size());
}

void TiledResidual::refresh_all() {
  Image taken(residual_.width, residual_.height);
  for (const Component& c : component_) taken.at(c.row, c.column) += double{c.factor};
  Image left = psf_.convolution()(taken);
  for (std::size_t i = 0; i < left.pixel.size(); ++i) left.pixel[i] = residual_.pixel[i] - left.pixel[i];
  load(left);
}

void TiledResidual::refresh(std::size_t index) {
  const int tile_v = static_cast<int>(index) / tiles_u_, tile_u = static_cast<int>(index) % tiles_u_;
  std::vector<PsfPatch> patches;
  for (std::size_t k = taken_[index]; k < component_.size(); ++k) {
    const Component& component = component_[k];
    const Overlap rows = overlap(tile_v, component.row, residual_.height);
    const Overlap columns = overlap(tile_u, component.column, residual_.width);
    if (rows.first >= rows.end || columns.first >= columns.end) continue;
    patches.push_back({psf_.at(rows.first + rows.shift, columns.first + columns.shift), component.factor, rows.first, rows.end,
                       columns.first, columns.end});
  }
  taken_[index] = component_.size();
  bound_[index] = subtract_and_peak(tile(index), patches.data(), patches.size(), psf_.columns());
  choose_bright(index);
}

/// The pixels of a tile above some part of its peak, where these are so few that to look at them alone takes less time.
void TiledResidual::choose_bright(std::size_t index) {
  constexpr float part = 0.8F;
  constexpr std::size_t most = 64;
  const float* const pixel = tile(index);
  const float peak = bound_[index];
  Bright& bright = bright_[index];
  bright.place.clear();
  bright.value.clear();
  bright.taken = component_.size();
  bright.peak = peak;
  rest_bound_[index] = nothing;
  if (peak == nothing) return;
  float level = part * peak;
  for (;;) {
    float rest = nothing;
    for (std::size_t i = 0; i < tile_pixels; ++i) {
      const float magnitude = std::abs(pixel[i]);
      if (magnitude >= level && bright.place.size() < most + 1) {
        bright.place.push_back(static_cast<int>(i));
        bright.value.push_back(pixel[i]);
      } else if (magnitude > rest) {
        rest = magnitude;
      }
    }
    rest_bound_[index] = rest;
    if (bright.place.size() <= most || level == peak) break;
    level = peak;  // too many: the brightest alone
    bright.place.clear();
    bright.value.clear();
  }
  bright.offset.clear();
  for (const int place : bright.place) bright.offset.push_back(place / side * psf_.columns() + place % side);
}

void TiledResidual::refresh_bright(std::size_t index) {
  Bright& bright = bright_[index];
  const int tile_v = static_cast<int>(index) / tiles_u_, tile_u = static_cast<int>(index) % tiles_u_;
  for (; bright.taken < component_.size(); ++bright.taken) {
    const Component& component = component_[bright.taken];
    const Overlap rows = overlap(tile_v, component.row, residual_.height);
    const Overlap columns = overlap(tile_u, component.column, residual_.width);
    if (rows.first >= rows.end || columns.first >= columns.end) continue;
    if (rows.whole() && columns.whole()) {
      subtract_at(psf_.at(rows.shift, columns.shift), component.factor, bright.offset.data(), bright.offset.size(),
                  bright.value.data());
      continue;
    }
    for (std::size_t i = 0; i < bright.place.size(); ++i) {
      const int r = bright.place[i] / side, c = bright.place[i] % side;
      if (r >= rows.first && r < rows.end && c >= columns.first && c < columns.end)
        bright.value[i] = std::fma(-component.factor, *psf_.at(r + rows.shift, c + columns.shift), bright.value[i]);
    }
  }
  bright.peak = nothing;
  for (const float value : bright.value) bright.peak = std::max(bright.peak, std::abs(value));
  bound_[index] = std::max(bright.peak, rest_bound_[index]);
}

}  // namespace misfit::imager
