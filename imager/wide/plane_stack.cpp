#include "imager/wide/plane_stack.h"

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

template <typename Real>
void PlaneStack<Real>::reserve(int plane_count, int band_tiles) {
  planes = plane_count;
  first_ = 0;
  held_ = shape.held_rows(band_tiles);
  cell_.reserve(offset(held_, 0, 0, 0));
  chunk_used_.assign(chunk_number(shape.rows(), 0), 0);
}

template <typename Real>
void PlaneStack<Real>::advance(int first, int threads) {
  const int from = first_, kept = std::clamp(held_ - (first - from), 0, shape.rows() - first);
  if (first == from) return;
  first_ = first;
  const auto chunks = static_cast<std::size_t>(shape.chunks());
  const std::size_t chunk_cells = offset(0, 1, 0, 0);
  // Each column of chunks is moved row after row, from the lowest up, so that none is written over before it has been moved.
  parallel_for(chunks, threads, [&](std::size_t i) {
    const int index = static_cast<int>(i);
    for (int row = first; row < first + kept; ++row)
      if (uses(row, index)) std::copy_n(cell_.data() + offset(row - from, index, 0, 0), chunk_cells, chunk(row, index, 0, 0));
  });
}

template <typename Real>
void PlaneStack<Real>::use_row(int row) {
  std::fill_n(chunk_used_.begin() + static_cast<std::ptrdiff_t>(chunk_number(row, 0)), shape.chunks(), char{1});
}

template <typename Real>
void PlaneStack<Real>::use_tiles(const std::vector<TilePlace>& tiles, int threads) {
  struct Chunk {
    int row;
    int index;
  };
  std::vector<Chunk> fresh;
  for (const TilePlace& tile : tiles)
    for (int row = tile.v * shape.tile; row < (tile.v + 1) * shape.tile + shape.width - 1; ++row)
      for (const int index : {tile.u, tile.u + 1}) {
        char& used = chunk_used_[chunk_number(row, index)];
        if (used == 0) fresh.push_back({row, index});
        used = 1;
      }
  const std::size_t chunk_cells = offset(0, 1, 0, 0);
  constexpr std::size_t at_once = 256;
  parallel_for((fresh.size() + at_once - 1) / at_once, threads, [&](std::size_t piece) {
    for (std::size_t i = piece * at_once; i < std::min(fresh.size(), (piece + 1) * at_once); ++i)
      std::fill_n(chunk(fresh[i].row, fresh[i].index, 0, 0), chunk_cells, std::complex<Real>(0));
  });
}

template <typename Real>
bool PlaneStack<Real>::holds(int q) const {
  const auto is_used = [&](int r) {
    const auto first = chunk_used_.begin() + static_cast<std::ptrdiff_t>(chunk_number(r, 0));
    return std::any_of(first, first + shape.chunks(), [](char used) { return used != 0; });
  };
  bool used = is_used(q + shape.margin());
  for_mirrored_rows(q, [&](int r) { used |= is_used(r); });
  return used;
}

template class PlaneStack<float>;
template class PlaneStack<double>;

}  // namespace misfit::imager
