#include "imager/coplanar/coplanar_setup.h"

namespace misfit::imager {

std::vector<std::vector<TileTask>> coloured_tasks(const TileOrder& order, const GridShape& shape) {
  std::vector<std::vector<TileTask>> colours(4);
  for (int v = 0; v < shape.tiles_v(); ++v)
    for (int u = 0; u < shape.tiles_u(); ++u) {
      const auto tile = static_cast<std::size_t>(v) * static_cast<std::size_t>(shape.tiles_u()) + static_cast<std::size_t>(u);
      if (order.samples[tile] != 0) colours[static_cast<std::size_t>(v % 2 * 2 + u % 2)].push_back({u, v, tile});
    }
  for (std::vector<TileTask>& tasks : colours)
    std::stable_sort(tasks.begin(), tasks.end(),
                     [&](const TileTask& a, const TileTask& b) { return order.samples[a.tile] > order.samples[b.tile]; });
  return colours;
}

}  // namespace misfit::imager
