#include "imager/clean/tiled_residual.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "imager/clean/tiled_residual_loops.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr int side = residual_tile_side, block_side = residual_block_side;
constexpr std::size_t block_pixels = std::size_t{block_side} * block_side;
constexpr std::size_t blocks_in_tile = std::size_t{blocks_along_tile} * blocks_along_tile;
constexpr float nothing = -std::numeric_limits<float>::infinity();

/// Components after which a block that must be looked at is brought up to date together with others, which takes threads.
constexpr std::size_t many = 128;
/// Of the peak: the bound above which blocks are brought up to date together.
constexpr float soon = 0.85F;
/// Of a convolution, that take as long as a component's part in a block; measured.
constexpr std::size_t pixels_a_patch = 3;

}  // namespace

TiledResidual::TiledResidual(const Image& residual, const TiledPsf& psf, int threads)
    : residual_(residual),
      psf_(psf),
      threads_(threads),
      tiles_u_(psf.tiles_u()),
      tiles_v_(psf.tiles_v()),
      bounded_(static_cast<std::size_t>(tiles_v_) * static_cast<std::size_t>(tiles_u_)),
      tile_bound_(bounded_.size()),
      row_bound_(static_cast<std::size_t>(tiles_v_)) {
  const std::size_t blocks = bounded_.size() * blocks_in_tile;
  pixel_.assign(blocks * block_pixels, std::numeric_limits<float>::quiet_NaN());
  taken_.resize(blocks);
  block_bound_.resize(blocks);
  parallel_for(row_bound_.size(), threads_, [&](std::size_t v) {
    std::vector<float> row(static_cast<std::size_t>(residual.width));
    for (int r = static_cast<int>(v) * side; r < std::min(residual.height, (static_cast<int>(v) + 1) * side); ++r) {
      std::copy_n(residual.row(r), residual.width, row.data());
      load_row(r, row.data());
    }
  });
  settle_all();
}

TiledResidual::Corner TiledResidual::tile_corner(std::size_t tile) const {
  const int index = static_cast<int>(tile);
  return {index / tiles_u_ * side, index % tiles_u_ * side};
}

TiledResidual::Corner TiledResidual::block_corner(std::size_t block) const {
  const Corner tile = tile_corner(block / blocks_in_tile);
  const int index = static_cast<int>(block % blocks_in_tile);
  return {tile.row + index / blocks_along_tile * block_side, tile.column + index % blocks_along_tile * block_side};
}

std::size_t TiledResidual::block_at(int row, int column) const {
  const int tile = row / side * tiles_u_ + column / side;
  const int block = row % side / block_side * blocks_along_tile + column % side / block_side;
  return static_cast<std::size_t>(tile) * blocks_in_tile + static_cast<std::size_t>(block);
}

float* TiledResidual::pixels(std::size_t block) {
  return pixel_.data() + block * block_pixels;
}

/// Takes over a row of pixels off which all components have been taken.
void TiledResidual::load_row(int row, const float* from) {
  for (int c = 0; c < residual_.width; c += block_side)
    std::copy(from + c, from + std::min(residual_.width, c + block_side),
              pixels(block_at(row, c)) + row % block_side * block_side);
}

/// Off all blocks all components have been taken.
void TiledResidual::settle_all() {
  spent_ = 0;
  const auto tiles_u = static_cast<std::size_t>(tiles_u_);
  parallel_for(row_bound_.size(), threads_, [&](std::size_t v) {
    for (std::size_t tile = v * tiles_u; tile < (v + 1) * tiles_u; ++tile) {
      for (std::size_t block = tile * blocks_in_tile; block < (tile + 1) * blocks_in_tile; ++block) {
        taken_[block] = component_.size();
        block_bound_[block] = largest_magnitude(pixels(block));
      }
      bounded_[tile] = component_.size();
      settle(tile);
    }
    settle_row(v);
  });
}

void TiledResidual::settle(std::size_t tile) {
  const float* const begin = &block_bound_[tile * blocks_in_tile];
  tile_bound_[tile] = *std::max_element(begin, begin + blocks_in_tile);
}

void TiledResidual::settle_row(std::size_t tile_row) {
  const float* const begin = &tile_bound_[tile_row * static_cast<std::size_t>(tiles_u_)];
  row_bound_[tile_row] = *std::max_element(begin, begin + tiles_u_);
}

void TiledResidual::subtract(int row, int column, float factor) {
  component_.add({row, column, factor});
  const int tile_v = row / side, tile_u = column / side;
  float* bound = tile_bound_.data();
  for (int v = 0; v < tiles_v_; ++v, bound += tiles_u_)
    row_bound_[static_cast<std::size_t>(v)] =
        raise_bounds(bound, psf_.between_tiles()(v - tile_v, -tile_u), tiles_u_, std::abs(factor));
}

Peak TiledResidual::peak() {
  float highest = nothing;
  do highest = *std::max_element(row_bound_.begin(), row_bound_.end());
  while (highest != nothing && refresh_tiles_at(highest));
  return highest == nothing ? Peak{} : first_peak(tiles_above(highest), highest);
}

Peak TiledResidual::first_peak(const std::vector<std::size_t>& tiles, float magnitude) {
  Peak first{residual_.height, 0, 0};
  for (const std::size_t tile : tiles)
    for (std::size_t block = tile * blocks_in_tile; block < (tile + 1) * blocks_in_tile; ++block) {
      if (block_bound_[block] != magnitude) continue;
      const Corner corner = block_corner(block);
      for (int i = 0; i < static_cast<int>(block_pixels); ++i) {
        const float value = pixels(block)[i];
        const int row = corner.row + i / block_side, column = corner.column + i % block_side;
        const bool earlier = row < first.row || (row == first.row && column < first.column);
        if (std::abs(value) == magnitude && earlier) first = {row, column, double{value}};
      }
    }
  return first;
}

/// Those of at least that bound.
std::vector<std::size_t> TiledResidual::tiles_above(float bound) const {
  std::vector<std::size_t> tiles;
  const auto tiles_u = static_cast<std::size_t>(tiles_u_);
  for (std::size_t v = 0; v < row_bound_.size(); ++v) {
    if (row_bound_[v] < bound) continue;
    for (std::size_t tile = v * tiles_u; tile < (v + 1) * tiles_u; ++tile)
      if (tile_bound_[tile] >= bound) tiles.push_back(tile);
  }
  return tiles;
}

/// Looks at the tiles of the highest bound. Returns whether there were any that had to be looked at.
bool TiledResidual::refresh_tiles_at(float highest) {
  bool any = false;
  for (const std::size_t tile : tiles_above(highest)) {
    if (bounded_[tile] < component_.size()) {
      any = true;
      bound_blocks(tile);
    }
    for (std::size_t block = tile * blocks_in_tile; block < (tile + 1) * blocks_in_tile; ++block) {
      if (block_bound_[block] < highest || taken_[block] == component_.size()) continue;
      any = true;
      if (component_.size() - taken_[block] > many) {
        refresh_together(soon * highest);
        return true;
      }
      spent_ += outstanding(block);
      refresh(block);
    }
    settle(tile);
    settle_row(tile / static_cast<std::size_t>(tiles_u_));
  }
  return any;
}

void TiledResidual::bound_blocks(std::size_t tile) {
  const Corner corner = tile_corner(tile);
  for (const auto& piece : component_.since(bounded_[tile]))
    raise_block_bounds(psf_.between_blocks(), piece, corner.row, corner.column, &block_bound_[tile * blocks_in_tile]);
  bounded_[tile] = component_.size();
}

std::size_t TiledResidual::outstanding(std::size_t block) const {
  std::size_t components = 0;
  for (const auto& piece : component_.since(taken_[block])) components += piece.size();
  return components;
}

void TiledResidual::refresh(std::size_t block) {
  const Corner corner = block_corner(block);
  for (const auto& piece : component_.since(taken_[block]))
    imager::subtract(psf_, piece, corner.row, corner.column, pixels(block));
  taken_[block] = component_.size();
  block_bound_[block] = largest_magnitude(pixels(block));
}

/// Brings blocks that could be as bright as that up to date, or all where that is cheaper in the long run: convolutions and
/// what is done between them then cost the same, and together no more than twice the least.
void TiledResidual::refresh_together(float level) {
  const std::vector<std::size_t> tiles = tiles_above(level);
  const auto for_blocks = [&](const auto& prepare, const auto& body) {
    constexpr std::size_t together = 8;  // tiles, which takes longer than to share them among threads
    parallel_for((tiles.size() + together - 1) / together, threads_, [&](std::size_t i) {
      for (std::size_t k = i * together; k < std::min(tiles.size(), (i + 1) * together); ++k) {
        prepare(tiles[k]);
        for (std::size_t block = tiles[k] * blocks_in_tile; block < (tiles[k] + 1) * blocks_in_tile; ++block)
          if (block_bound_[block] >= level && taken_[block] < component_.size()) body(block);
        settle(tiles[k]);
      }
    });
  };
  std::atomic<std::size_t> patches{0};
  for_blocks([&](std::size_t tile) { bound_blocks(tile); }, [&](std::size_t block) { patches += outstanding(block); });
  spent_ += patches;
  if (spent_ * pixels_a_patch > residual_.pixel.size()) return refresh_all();
  for_blocks([](std::size_t) {}, [&](std::size_t block) { refresh(block); });
  for (std::size_t v = 0; v < row_bound_.size(); ++v) settle_row(v);
}

void TiledResidual::refresh_all() {
  std::vector<std::vector<PointComponent>> in_row(static_cast<std::size_t>(residual_.height));
  for (const auto& piece : component_.since(0))
    for (const PointComponent& component : piece) in_row[static_cast<std::size_t>(component.row)].push_back(component);
  const auto read = [&](int row, float* pixels) {
    for (const PointComponent& component : in_row[static_cast<std::size_t>(row)]) pixels[component.column] += component.factor;
  };
  const auto write = [&](int row, float* pixels) {
    std::transform(residual_.row(row), residual_.row(row) + residual_.width, pixels, pixels,
                   [](double all, float taken) { return static_cast<float>(all - double{taken}); });
    load_row(row, pixels);
  };
  psf_.convolution()(read, write);
  settle_all();
}

}  // namespace misfit::imager
