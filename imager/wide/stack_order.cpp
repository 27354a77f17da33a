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
  std::vector<std::int32_t> tile(channels), plane(channels);
  std::vector<double> period(channels);
  for (std::size_t r = piece.begin_row; r < piece.end_row; ++r) {
    const float* weight = samples.weight == nullptr ? nullptr : samples.weight + r * channels;
    if (weight != nullptr && std::all_of(weight, weight + channels, [](float w) { return w == 0; })) continue;
    for (const bool mirrored : {false, true}) {
      const StackRow row(&at.uvw_m[3 * r], mirrored, o.scale);
      first_taps(row, o.shape, o.width_w, at.frequency_hz.data(), static_cast<int>(channels),
                 {tile.data(), plane.data(), period.data()});
      bool open = false;
      for (std::size_t c = 0; c < channels; ++c) {
        const bool wanted = weight == nullptr || weight[c] != 0;
        if (!wanted || plane[c] + o.width_w <= 0) {
          open = false;
          continue;
        }
        if (open && tile[c] == tile[c - 1] && plane[c] == plane[c - 1] && period[c] == period[c - 1] &&
            runs.back().run.count < longest_run) {
          ++runs.back().run.count;
        } else {
          runs.push_back(
              {static_cast<std::uint32_t>(tile[c]),
               {piece.block, static_cast<std::uint32_t>(r), plane[c], static_cast<std::uint32_t>(c) & 0xFFFFF, 1, mirrored}});
        }
        open = true;
      }
    }
  }
  return runs;
}

void mark_planes(StackOrder& order, int width_w) {
  std::ptrdiff_t planes = 0;
  for (const StackRun& run : order.run) planes = std::max<std::ptrdiff_t>(planes, run.plane + width_w);
  std::vector<char> first_tap(static_cast<std::size_t>(planes + width_w));
  const auto plane_0 = first_tap.begin() + width_w;
  for (const StackRun& run : order.run) plane_0[run.plane] = 1;
  order.plane_used.resize(static_cast<std::size_t>(planes));
  int since = width_w;  // planes since the last one that holds a first tap
  for (std::ptrdiff_t k = -width_w; k < planes; ++k) {
    since = plane_0[k] != 0 ? 0 : since + 1;
    if (k >= 0) order.plane_used[static_cast<std::size_t>(k)] = since < width_w ? 1 : 0;
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
  mark_planes(order, options.width_w);
  return order;
}

}  // namespace misfit::imager
