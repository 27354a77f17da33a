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

/// Finds the runs of rows of one block. Places are asked for at few channels: where they are the same at two of them they are
/// so between, since along rising or falling frequencies everything of a place rises or falls.
class RunFinder {
 public:
  RunFinder(const Piece& piece, const WantedSamples& samples, const StackOrderOptions& options)
      : piece_(piece), samples_(samples), o_(options), channels_(samples.at->channels()) {
    const std::vector<double>& frequency = samples.at->frequency_hz;
    every_ = !std::is_sorted(frequency.begin(), frequency.end()) && !std::is_sorted(frequency.rbegin(), frequency.rend());
    for (auto* values : {&tile_, &plane_, &mirrored_}) values->resize(channels_);
    period_.resize(channels_);
  }

  std::vector<TiledRun> find() {
    for (std::size_t row = piece_.begin_row; row < piece_.end_row; ++row) add_row(row);
    return std::move(runs_);
  }

 private:
  void add_row(std::size_t row) {
    const float* const weight = samples_.weight == nullptr ? nullptr : samples_.weight + row * channels_;
    const auto wanted = [weight](std::size_t c) { return weight == nullptr || weight[c] != 0; };
    std::size_t first = 0;
    while (first < channels_ && !wanted(first)) ++first;
    if (first == channels_) return;
    find_changes(StackRow(&samples_.at->uvw_m[3 * row], false, o_.scale));
    for (std::size_t i = 0; i + 1 < change_.size(); ++i)
      for (std::size_t begin = std::max(change_[i], first); begin < change_[i + 1];) {
        std::size_t end = begin;
        while (end < change_[i + 1] && end - begin < longest_run && wanted(end)) ++end;
        if (end > begin) add_run(row, change_[i], begin, end);
        begin = std::max(end, begin + 1);
      }
  }

  /// The channels at which the place is not that of the one before, from the first to the one after the last.
  void find_changes(const StackRow& row) {
    change_.assign(1, 0);
    if (every_) {
      locate(row, 0, channels_);
      for (std::size_t c = 1; c < channels_; ++c)
        if (!same(c - 1, c)) change_.push_back(c);
    } else {
      locate(row, 0, 1);
      locate(row, channels_ - 1, channels_);
      find_between(row, 0, channels_ - 1);
    }
    change_.push_back(channels_);
  }

  /// Finds the changes among channels low + 1 … high, both of which ends have been located.
  void find_between(const StackRow& row, std::size_t low, std::size_t high) {
    if (low >= high || same(low, high)) return;
    if (high - low <= at_once) {
      locate(row, low + 1, high);
      for (std::size_t c = low + 1; c <= high; ++c)
        if (!same(c - 1, c)) change_.push_back(c);
      return;
    }
    const std::size_t middle = low + (high - low) / 2;
    locate(row, middle, middle + 1);
    find_between(row, low, middle);
    find_between(row, middle, high);
  }

  void locate(const StackRow& row, std::size_t begin, std::size_t end) {
    if (begin < end)
      first_taps(row, o_.shape, o_.width_w, &samples_.at->frequency_hz[begin], static_cast<int>(end - begin),
                 {&tile_[begin], &plane_[begin], &mirrored_[begin], &period_[begin]});
  }
  bool same(std::size_t a, std::size_t b) const {
    return tile_[a] == tile_[b] && plane_[a] == plane_[b] && period_[a] == period_[b];
  }

  /// Adds a run at the place that channel `known` has.
  void add_run(std::size_t row, std::size_t known, std::size_t begin, std::size_t end) {
    runs_.push_back(
        {static_cast<std::uint32_t>(tile_[known]),
         {piece_.block, static_cast<std::uint32_t>(row), plane_[known], static_cast<std::uint32_t>(begin) & 0xFFFFF,
          static_cast<std::uint32_t>(end - begin) & longest_run, static_cast<std::uint32_t>(mirrored_[known]) & 1}});
  }

  static constexpr std::size_t at_once = 8;  ///< channels located together: vectors take several in the time of one

  const Piece& piece_;
  const WantedSamples& samples_;
  const StackOrderOptions& o_;
  std::size_t channels_;
  bool every_;                                         ///< frequencies neither rise nor fall throughout
  std::vector<std::int32_t> tile_, plane_, mirrored_;  ///< [channel], where located
  std::vector<double> period_;
  std::vector<std::size_t> change_;
  std::vector<TiledRun> runs_;
};

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
               [&](std::size_t i) { part[i] = RunFinder(pieces[i], blocks[pieces[i].block], options).find(); });
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
