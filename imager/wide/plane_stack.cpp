#include "imager/wide/plane_stack.h"

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

template <typename Real>
void PlaneStack<Real>::reserve(int plane_count) {
  planes = plane_count;
  cell_.reserve(shape.cells() * static_cast<std::size_t>(planes * grids));
  row_used.assign(static_cast<std::size_t>(shape.rows()), 0);
}

template <typename Real>
void PlaneStack<Real>::use_rows(const std::vector<RowRange>& ranges, int threads) {
  std::vector<int> fresh;
  for (const RowRange& range : ranges)
    for (int r = range.begin; r < range.end; ++r) {
      char& used = row_used[static_cast<std::size_t>(r)];
      if (used == 0) fresh.push_back(r);
      used = 1;
    }
  const std::size_t row_cells = offset(1, 0, 0, 0);
  parallel_for(fresh.size(), threads,
               [&](std::size_t i) { std::fill_n(chunk(fresh[i], 0, 0, 0), row_cells, std::complex<Real>(0)); });
}

template <typename Real>
bool PlaneStack<Real>::holds(int q) const {
  const auto is_used = [&](int r) { return row_used[static_cast<std::size_t>(r)] != 0; };
  bool used = is_used(q + shape.margin());
  for_mirrored_rows(q, [&](int r) { used |= is_used(r); });
  return used;
}

template class PlaneStack<float>;
template class PlaneStack<double>;

}  // namespace misfit::imager
