#include "imager/clean/component_log.h"

#include <algorithm>
#include <tuple>

#include "imager/clean/tiled_psf.h"

namespace misfit::imager {
namespace {

constexpr std::size_t shortest = 16;  ///< components of the shortest piece that is merged

/// In the order of tiles: what lies close together finds its part of the PSF in a cache.
auto place(const PointComponent& c) {
  return std::tuple(c.row / residual_tile_side, c.column / residual_tile_side, c.row, c.column);
}

/// Replaces components of one pixel, which are neighbours, by their sum.
void sum_neighbours(std::vector<PointComponent>& sorted) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (place(sorted[i]) == place(sorted[kept]))
      sorted[kept].factor += sorted[i].factor;
    else
      sorted[++kept] = sorted[i];
  }
  sorted.resize(kept + 1);
}

}  // namespace

void ComponentLog::add(const PointComponent& component) {
  component_.push_back(component);
  if (size() % shortest != 0) return;
  const auto before = [](const PointComponent& a, const PointComponent& b) { return place(a) < place(b); };
  std::vector<PointComponent> piece(component_.end() - shortest, component_.end());
  std::stable_sort(piece.begin(), piece.end(), before);
  sum_neighbours(piece);
  for (std::size_t level = 0;; ++level) {
    if (level == merged_.size()) merged_.emplace_back();
    auto& pieces = merged_[level];
    pieces.push_back(std::move(piece));
    if (pieces.size() % 2 != 0) return;
    const auto& a = pieces[pieces.size() - 2];
    const auto& b = pieces.back();
    piece.clear();
    std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(piece), before);
    sum_neighbours(piece);
  }
}

ComponentLog::Pieces ComponentLog::since(std::size_t first) const {
  Pieces pieces;
  const std::size_t end = size();
  while (first < end) {
    std::size_t level = 0, length = shortest;
    if (first % length != 0 || first + length > end) {
      const std::size_t next = std::min(end, (first / length + 1) * length);
      pieces.push_back({&component_[first], next - first});
      first = next;
      continue;
    }
    for (; first % (2 * length) == 0 && first + 2 * length <= end; length *= 2) ++level;
    const std::vector<PointComponent>& merged = merged_[level][first / length];
    pieces.push_back({merged.data(), merged.size()});
    first += length;
  }
  return pieces;
}

}  // namespace misfit::imager
