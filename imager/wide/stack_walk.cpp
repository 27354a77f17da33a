#include "imager/wide/stack_walk.h"

namespace misfit::imager {

std::vector<Slab> slabs_of(const StackOrder& order, int most_pairs) {
  std::vector<Slab> slabs;
  for (std::size_t k = 0; k < order.pair_used.size(); ++k) {
    if (order.pair_used[k] == 0) continue;
    const int plane = static_cast<int>(k);
    if (slabs.empty() || slabs.back().pairs == most_pairs || slabs.back().first + slabs.back().pairs != plane)
      slabs.push_back({plane, 0});
    ++slabs.back().pairs;
  }
  return slabs;
}

std::vector<Band> bands_of(const StackShape& shape, int tiles) {
  std::vector<Band> bands;
  for (int v = 0; v < shape.tiles_v(); v += tiles) bands.push_back({v, std::min(v + tiles, shape.tiles_v())});
  return bands;
}

std::vector<std::vector<StackTask>> tasks_of(const StackOrder& order, const StackShape& shape, const Slab& slab, int width_w,
                                             const Band& band) {
  std::vector<std::vector<StackTask>> colours;
  const auto at = [&](std::size_t i) { return order.run.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto index = [&](auto run) { return static_cast<std::size_t>(run - order.run.begin()); };
  const auto below = [](const StackRun& run, int plane) { return run.plane < plane; };
  for (const StackPlanes& range : slab.ranges()) {
    const std::size_t first_colour = colours.size();
    colours.resize(first_colour + 4);
    const int range_end = range.first + range.planes;
    std::size_t tile = static_cast<std::size_t>(band.begin) * static_cast<std::size_t>(shape.tiles_u());
    for (int v = band.begin; v < band.end; ++v)
      for (int u = 0; u < shape.tiles_u(); ++u, ++tile) {
        if (order.begin[tile] == order.begin[tile + 1]) continue;
        const auto begin = std::lower_bound(at(order.begin[tile]), at(order.begin[tile + 1]), range.first - width_w + 1, below);
        const auto end = std::lower_bound(begin, at(order.begin[tile + 1]), range_end, below);
        if (begin == end) continue;
        const int lowest = std::max(begin->plane, range.first), highest = std::min((end - 1)->plane + width_w, range_end);
        colours[first_colour + static_cast<std::size_t>(v % 2 * 2 + u % 2)].push_back(
            {u, v, index(begin), index(end), {lowest, highest - lowest}});
      }
  }
  for (std::vector<StackTask>& tasks : colours)
    std::stable_sort(tasks.begin(), tasks.end(),
                     [](const StackTask& a, const StackTask& b) { return a.end - a.begin > b.end - b.begin; });
  return colours;
}

}  // namespace misfit::imager
