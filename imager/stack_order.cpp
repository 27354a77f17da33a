#include "imager/stack_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/constants.h"
#include "imager/parallel.h"

namespace misfit::imager {
namespace {

constexpr std::uint32_t longest_run = (1U << 11) - 1;
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
    for (const bool mirrored : {false, true}) {
      const StackRow row(&at.uvw_m[3 * r], mirrored, o.scale);
      bool open = false;
      for (std::size_t channel = 0; channel < at.channels(); ++channel) {
        const double frequency = at.frequency_hz[channel];
        const std::int32_t plane = row.along_w(frequency, o.width_w).first;
        if (plane + o.width_w <= 0 || !wanted(piece.block, r * at.channels() + channel)) {
          open = false;
          continue;
        }
        const int column = TapPosition(reduced(row.u_per_hz * frequency, s.nu), s.width).first + s.margin();
        const int line = TapPosition(reduced(row.v_per_hz * frequency, s.nv), s.width).first + s.margin();
        const auto tile = static_cast<std::uint32_t>(line / s.tile * s.tiles_u() + column / s.tile);
        if (open && runs.back().tile == tile && runs.back().run.plane == plane && runs.back().run.count < longest_run) {
          ++runs.back().run.count;
        } else {
          runs.push_back({tile,
                          {piece.block, static_cast<std::uint32_t>(r), plane, static_cast<std::uint32_t>(channel) & 0xFFFFF, 1,
                           mirrored}});
        }
        open = true;
      }
    }
  }
  return runs;
}

void mark_planes(StackOrder& order, int width_w) {
  int planes = 0;
  for (const StackRun& run : order.run) planes = std::max(planes, run.plane + width_w);
  std::vector<char> first_tap(static_cast<std::size_t>(planes + width_w));  // [plane + width_w]
  for (const StackRun& run : order.run) first_tap[static_cast<std::size_t>(run.plane + width_w)] = 1;
  order.plane_used.resize(static_cast<std::size_t>(planes));
  int since = width_w;  // planes since the last one that holds a first tap
  for (int k = -width_w; k < planes; ++k) {
    since = first_tap[static_cast<std::size_t>(k + width_w)] != 0 ? 0 : since + 1;
    if (k >= 0) order.plane_used[static_cast<std::size_t>(k)] = since < width_w ? 1 : 0;
  }
}

}  // namespace

StackScale::StackScale(const StackShape& shape, const Facet& at, double plane_step)
    : u_cells_per_m_hz(-at.geometry.cell_rad * shape.nu / speed_of_light_m_s),
      v_cells_per_m_hz(at.geometry.cell_rad * shape.nv / speed_of_light_m_s),
      planes_per_m_hz(1 / (plane_step * speed_of_light_m_s)),
      turns_per_m_hz(1 / speed_of_light_m_s),
      facet(at) {}

StackRow::StackRow(const double* uvw_m, bool mirror, const StackScale& scale) : mirrored(mirror) {
  const double sign = mirror ? -1 : 1;
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
