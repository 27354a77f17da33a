#include "imager/wide/stack_order.h"

#include <algorithm>

#include "imager/coplanar/tile_order.h"
#include "imager/numerics/parallel.h"

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

std::vector<Piece> pieces_of(const std::vector<WantedSamples>& blocks) {
  std::vector<Piece> pieces;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t row = 0; row < blocks[b].at->rows(); row += rows_a_piece)
      pieces.push_back({static_cast<std::uint32_t>(b), row, std::min(row + rows_a_piece, blocks[b].at->rows())});
  return pieces;
}

std::vector<TiledRun> find_runs(const Piece& piece, const WantedSamples& samples, const StackOrderOptions& o) {
  std::vector<TiledRun> runs;
  const SampleCoordinates& at = *samples.at;
  const std::size_t channels = at.channels();
  std::vector<std::int32_t> tile(channels), plane(channels), mirrored(channels);
  std::vector<double> period(channels);
  for (std::size_t r = piece.begin_row; r < piece.end_row; ++r) {
    const float* weight = samples.weight == nullptr ? nullptr : samples.weight + r * channels;
    if (weight != nullptr && std::all_of(weight, weight + channels, [](float w) { return w == 0; })) continue;
    first_taps(StackRow(&at.uvw_m[3 * r], false, o.scale), o.shape, o.width_w, at.frequency_hz.data(),
               static_cast<int>(channels), {tile.data(), plane.data(), mirrored.data(), period.data()});
    bool open = false;
    for (std::size_t c = 0; c < channels; ++c) {
      if (weight != nullptr && weight[c] == 0) {
        open = false;
      } else if (open && tile[c] == tile[c - 1] && plane[c] == plane[c - 1] && period[c] == period[c - 1] &&
                 runs.back().run.count < longest_run) {
        ++runs.back().run.count;
      } else {
        runs.push_back({static_cast<std::uint32_t>(tile[c]),
                        {piece.block, static_cast<std::uint32_t>(r), plane[c], static_cast<std::uint32_t>(c) & 0xFFFFF, 1,
                         static_cast<std::uint32_t>(mirrored[c]) & 1}});
        open = true;
      }
    }
  }
  return runs;
}

void mark_pairs(StackOrder& order, int width_w) {
  std::int32_t lowest = 0, highest = -1;
  for (const StackRun& run : order.run) {
    lowest = std::min(lowest, run.plane);
    highest = std::max(highest, run.plane + width_w - 1);
  }
  const std::ptrdiff_t pairs = std::max(highest + 1, -lowest);
  std::vector<char> first_tap(static_cast<std::size_t>(2 * pairs));
  for (const StackRun& run : order.run) first_tap[static_cast<std::size_t>(run.plane + pairs)] = 1;
  order.pair_used.resize(static_cast<std::size_t>(pairs));
  for (std::ptrdiff_t first = -pairs; first < pairs; ++first) {
    if (first_tap[static_cast<std::size_t>(first + pairs)] == 0) continue;
    for (std::ptrdiff_t k = first; k < first + width_w; ++k) order.pair_used[static_cast<std::size_t>(k < 0 ? -1 - k : k)] = 1;
  }
}

}  // namespace

StackOrder order_for_stack(const std::vector<WantedSamples>& blocks, const StackOrderOptions& options) {
  for (const WantedSamples& block : blocks) check_channels(block.at->channels());
  const std::vector<Piece> pieces = pieces_of(blocks);
  std::vector<std::vector<TiledRun>> part(pieces.size());
  parallel_for(pieces.size(), options.threads,
               [&](std::size_t i) { part[i] = find_runs(pieces[i], blocks[pieces[i].block], options); });
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
  mark_pairs(order, options.width_w);
  return order;
}

}  // namespace misfit::imager
