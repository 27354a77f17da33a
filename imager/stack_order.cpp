#include "imager/stack_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/constants.h"
#include "imager/parallel.h"
#include "imager/tile_order.h"

namespace misfit::imager {
namespace {

constexpr std::uint32_t longest_run = (1U << 12) - 1;
constexpr std::size_t rows_a_piece = 4096;  // fixed, so that the order does not depend on the number of threads

struct TiledRun {
  std::uint32_t tile;
  StackRun run;
};

struct Piece {
  std::uint32_t block;
  std::size_t begin_row;
  std::size_t end_row;
};

std::vector<Piece> pieces_of(const std::vector<const SampleCoordinates*>& blocks) {
  std::vector<Piece> pieces;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t row = 0; row < blocks[b]->rows(); row += rows_a_piece)
      pieces.push_back({static_cast<std::uint32_t>(b), row, std::min(row + rows_a_piece, blocks[b]->rows())});
  return pieces;
}

template <typename Wanted>
std::vector<TiledRun> find_runs(const Piece& piece, const SampleCoordinates& at, const Wanted& wanted,
                                const StackOrderOptions& o) {
  std::vector<TiledRun> runs;
  const StackShape& s = o.shape;
  for (std::size_t r = piece.begin_row; r < piece.end_row; ++r) {
    const StackRow row(&at.uvw_m[3 * r], o.scale);
    bool open = false;
    for (std::size_t channel = 0; channel < at.channels(); ++channel) {
      if (!wanted(piece.block, r * at.channels() + channel)) {
        open = false;
        continue;
      }
      const double frequency = at.frequency_hz[channel];
      const int column = TapPosition(reduced(row.u_per_hz * frequency, s.nu), s.width).first + s.margin();
      const int line = TapPosition(reduced(row.v_per_hz * frequency, s.nv), s.width).first + s.margin();
      const auto tile = static_cast<std::uint32_t>(line / s.tile * s.tiles_u() + column / s.tile);
      const std::int32_t plane = TapPosition(row.w_per_hz * frequency, o.width_w).first;
      if (open && runs.back().tile == tile && runs.back().run.plane == plane && runs.back().run.count < longest_run) {
        ++runs.back().run.count;
      } else {
        runs.push_back(
            {tile, {piece.block, static_cast<std::uint32_t>(r), plane, static_cast<std::uint32_t>(channel) & 0xFFFFF, 1}});
      }
      open = true;
    }
  }
  return runs;
}

void mark_planes(StackOrder& order, int width_w) {
  if (order.run.empty()) return;
  const auto [low, high] = std::minmax_element(order.run.begin(), order.run.end(),
                                               [](const StackRun& a, const StackRun& b) { return a.plane < b.plane; });
  order.first_plane = low->plane;
  const int planes = high->plane - low->plane + width_w;
  order.plane_used.resize(static_cast<std::size_t>(planes));
  for (const StackRun& run : order.run) order.plane_used[static_cast<std::size_t>(run.plane - order.first_plane)] = 1;
  for (std::size_t k = order.plane_used.size(); k-- > 0;)  // a first tap is followed by the others
    for (std::size_t tap = 1; tap < static_cast<std::size_t>(width_w) && order.plane_used[k] == 0 && tap <= k; ++tap)
      order.plane_used[k] = order.plane_used[k - tap] == 1 ? 2 : 0;
}

}  // namespace

StackScale::StackScale(const StackShape& shape, const Facet& at, double plane_step)
    : u_cells_per_m_hz(-at.geometry.cell_rad * shape.nu / speed_of_light_m_s),
      v_cells_per_m_hz(at.geometry.cell_rad * shape.nv / speed_of_light_m_s),
      planes_per_m_hz(1 / (plane_step * speed_of_light_m_s)),
      turns_per_m_hz(1 / speed_of_light_m_s),
      facet(at) {}

StackRow::StackRow(const double* uvw_m, const StackScale& scale) : folded(uvw_m[2] < 0) {
  const double sign = folded ? -1 : 1;
  const double u = sign * uvw_m[0], v = sign * uvw_m[1], w = sign * uvw_m[2];
  const Facet& f = scale.facet;
  u_per_hz = (u + f.slope_l * w) * scale.u_cells_per_m_hz;
  v_per_hz = (v + f.slope_m * w) * scale.v_cells_per_m_hz;
  w_per_hz = w * scale.planes_per_m_hz;
  turns_per_hz = (u * f.geometry.centre.l + v * f.geometry.centre.m + w * f.middle) * scale.turns_per_m_hz;
}

StackOrder order_for_stack(const std::vector<const SampleCoordinates*>& blocks,
                           const std::function<bool(std::size_t, std::size_t)>& wanted, const StackOrderOptions& options) {
  for (const SampleCoordinates* block : blocks) check_channels(block->channels());
  const std::vector<Piece> pieces = pieces_of(blocks);
  std::vector<std::vector<TiledRun>> part(pieces.size());
  parallel_for(pieces.size(), options.threads,
               [&](std::size_t i) { part[i] = find_runs(pieces[i], *blocks[pieces[i].block], wanted, options); });
  const auto tiles = static_cast<std::size_t>(options.shape.tiles_u()) * static_cast<std::size_t>(options.shape.tiles_v());
  StackOrder order;
  order.begin.resize(tiles + 1);
  for (const std::vector<TiledRun>& runs : part)
    for (const TiledRun& r : runs) ++order.begin[r.tile + 1];
  for (std::size_t tile = 0; tile < tiles; ++tile) order.begin[tile + 1] += order.begin[tile];
  order.run.resize(order.begin.back());
  std::vector<std::size_t> next(order.begin.begin(), order.begin.end() - 1);
  for (const std::vector<TiledRun>& runs : part)
    for (const TiledRun& r : runs) order.run[next[r.tile]++] = r.run;
  parallel_for(tiles, options.threads, [&](std::size_t tile) {
    const auto at = [&](std::size_t i) { return order.run.begin() + static_cast<std::ptrdiff_t>(i); };
    std::stable_sort(at(order.begin[tile]), at(order.begin[tile + 1]),
                     [](const StackRun& a, const StackRun& b) { return a.plane < b.plane; });
  });
  mark_planes(order, options.width_w);
  return order;
}

}  // namespace misfit::imager
