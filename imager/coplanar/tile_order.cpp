#include "imager/coplanar/tile_order.h"

#include <algorithm>
#include <stdexcept>

#include "imager/numerics/parallel.h"
#include "imager/transform/sampling.h"
#include "imager/transform/span_sums.h"

namespace misfit::imager {
namespace {

constexpr std::size_t chunks = 32;  // fixed, so that the order of sums does not depend on the number of threads
constexpr std::uint32_t longest_run = (1U << 12) - 1;

struct TiledRun {
  std::uint32_t tile;
  SampleRun run;
};

/// Finds the tile that a sample's first tap falls into. Values that are the same for all samples are worked out beforehand:
/// divisions of integers would take longer than all the rest.
class TileFinder {
 public:
  explicit TileFinder(const GridShape& shape)
      : shape_(shape),
        tiles_u_(shape.tiles_u()),
        per_cell_(1.0 / shape.tile),
        beyond_u_(beyond(0.5 * shape.nu)),
        beyond_v_(beyond(0.5 * shape.nv)) {}

  struct Place {
    int column;
    int line;
  };
  Place place(double u, double v, bool folded) const {
    const PeriodicPosition at(u, v, folded, shape_);
    return {tile_of(shape_.first_column(TapPosition(at.u, shape_.width).first)),
            tile_of(shape_.first_row(TapPosition(at.v, shape_.width).first))};
  }
  std::uint32_t number(const Place& place) const { return static_cast<std::uint32_t>(place.line * tiles_u_ + place.column); }

  /// The positions, in cells, of samples whose first tap falls into one tile; none lie beyond the grid.
  struct Box {
    double u_low, u_end, v_low, v_end;
    bool holds(double u, double v) const { return u >= u_low && u < u_end && v >= v_low && v < v_end; }
  };
  Box box(const Place& place) const {
    const GridShape& s = shape_;
    const double to_first = 0.5 * s.width - 1;  // the first tap is the whole part of position − to_first
    const double u = place.column * s.tile - s.first_column(0) + to_first, v = place.line * s.tile - s.first_row(0) + to_first;
    return {std::max(u, -0.5 * s.nu), std::min(u + s.tile, beyond_u_), v, std::min(v + s.tile, beyond_v_)};
  }

 private:
  static double beyond(double edge) { return std::nextafter(edge, 2 * edge); }
  /// The whole part of cell / tile: half a cell is more than rounding takes off.
  int tile_of(int cell) const { return static_cast<int>((cell + 0.5) * per_cell_); }

  const GridShape& shape_;
  int tiles_u_;
  double per_cell_;
  double beyond_u_, beyond_v_;  ///< the least positions beyond the grid
};

/// The runs of a range of rows, in order.
class RunFinder {
 public:
  RunFinder(const VisibilityBlock& block, const VisibilitySets& sets, const GridShape& shape, const ImageGeometry& geometry,
            Wanted wanted)
      : sums(sets.size()), block_(block), sets_(sets), shape_(shape), scale_(shape, geometry), tiles_(shape), wanted_(wanted) {}

  void find(std::size_t begin_row, std::size_t end_row) {
    span_begin_ = span_end_ = begin_row * block_.channels();
    if (block_.channels() == 1)
      find_among_rows(begin_row, end_row);
    else
      for (std::size_t row = begin_row; row < end_row; ++row) find_in_row(row);
    close_span();
  }

  std::vector<TiledRun> runs;
  std::vector<SampleSums> sums;  ///< [set]

 private:
  void find_in_row(std::size_t row) {
    const FoldedRow folded(&block_.uvw_m[3 * row], scale_);
    const std::size_t channels = block_.channels();
    const double* const frequency = block_.frequency_hz.data();
    for (std::size_t channel = 0; channel < channels;) {
      const double u = folded.u_per_hz * frequency[channel], v = folded.v_per_hz * frequency[channel];
      std::size_t end = channel + 1;
      if (wants(row * channels + channel, u, v)) {
        const TileFinder::Place place = tiles_.place(u, v, folded.folded);
        if (end < channels) end = end_of_run(row, channel, tiles_.box(place), folded);
        add_run(tiles_.number(place), row, channel, end - channel);
      }
      channel = end;
    }
  }

  std::size_t end_of_run(std::size_t row, std::size_t first, const TileFinder::Box& box, const FoldedRow& folded) const {
    const std::size_t channels = block_.channels();
    const double* const frequency = block_.frequency_hz.data();
    std::size_t end = first + 1;
    while (end < channels && end - first < longest_run && usable(row * channels + end) &&
           box.holds(folded.u_per_hz * frequency[end], folded.v_per_hz * frequency[end]))
      ++end;
    return end;
  }

  /// Finds the runs of rows of one channel.
  void find_among_rows(std::size_t begin_row, std::size_t end_row) {
    const double frequency = block_.frequency_hz.front();
    for (std::size_t row = begin_row; row < end_row;) {
      const FoldedRow folded(&block_.uvw_m[3 * row], scale_);
      const double u = folded.u_per_hz * frequency, v = folded.v_per_hz * frequency;
      std::size_t end = row + 1;
      if (wants(row, u, v)) {
        const TileFinder::Place place = tiles_.place(u, v, folded.folded);
        const TileFinder::Box box = tiles_.box(place);
        const std::size_t limit = std::min(end_row, row + longest_run);
        if (box.holds(u, v))  // it is where it seems to be, not where it comes by periodicity
          while (end < limit && usable(end) && holds_row(box, end, frequency)) ++end;
        add_run(tiles_.number(place), row, 0, end - row);
      }
      row = end;
    }
  }
  bool holds_row(const TileFinder::Box& box, std::size_t row, double frequency) const {
    const FoldedRow folded(&block_.uvw_m[3 * row], scale_);
    return box.holds(folded.u_per_hz * frequency, folded.v_per_hz * frequency);
  }

  bool takes_sums() const { return wanted_ == Wanted::imaging || wanted_ == Wanted::imaging_beyond; }
  bool usable(std::size_t sample) const { return wanted_ == Wanted::all || block_.weight[sample] != 0; }

  bool wants(std::size_t sample, double u, double v) {
    if (!usable(sample)) return false;
    if (wanted_ != Wanted::imaging || inside_grid(u / shape_.nu, v / shape_.nv)) return true;
    for (SampleSums& of_set : sums) ++of_set.outside_grid;
    return false;
  }

  void add_run(std::uint32_t tile, std::size_t row, std::size_t channel, std::size_t count) {
    runs.push_back({tile,
                    {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(channel) & 0xFFFFF,
                     static_cast<std::uint32_t>(count) & longest_run}});
    if (!takes_sums()) return;
    for (SampleSums& of_set : sums) of_set.used += count;
    const std::size_t first = row * block_.channels() + channel;
    if (std::any_of(block_.weight.data() + span_end_, block_.weight.data() + first, [](float w) { return w != 0; })) {
      close_span();
      span_begin_ = first;
    }
    span_end_ = first + count;
  }

  /// Sums are taken of spans, since whole vectors are quicker: all samples of weight other than 0 from the first to the last.
  void close_span() {
    if (sets_.empty()) return;  // predicted samples have neither sums nor weights
    const float* const weight = block_.weight.data() + span_begin_;
    const std::size_t count = span_end_ - span_begin_;
    for (std::size_t i = 0; i < sets_.size(); ++i)
      std::visit([&](const auto* visibility) { add_span_to_sums(weight, visibility + span_begin_, count, sums[i]); }, sets_[i]);
  }

  const VisibilityBlock& block_;
  const VisibilitySets& sets_;
  const GridShape& shape_;
  CellScale scale_;
  TileFinder tiles_;
  Wanted wanted_;
  std::size_t span_begin_ = 0;
  std::size_t span_end_ = 0;
};

}  // namespace

void check_channels(std::size_t channels) {
  constexpr std::size_t most = 1U << 20;
  if (channels > most)
    throw std::invalid_argument(std::to_string(channels) + " channels in one spectral window; at most " + std::to_string(most) +
                                " are supported");
}

TileOrder order_by_tile(const VisibilityBlock& block, const VisibilitySets& sets, const GridShape& shape,
                        const ImageGeometry& geometry, Wanted wanted, int threads) {
  check_channels(block.channels());
  std::vector<RunFinder> part(chunks, RunFinder(block, sets, shape, geometry, wanted));
  parallel_for(chunks, threads,
               [&](std::size_t i) { part[i].find(block.rows() * i / chunks, block.rows() * (i + 1) / chunks); });

  const auto tiles = static_cast<std::size_t>(shape.tiles_u()) * static_cast<std::size_t>(shape.tiles_v());
  TileOrder order{
      std::vector<std::size_t>(tiles + 1), std::vector<std::size_t>(tiles), {}, 0, std::vector<SampleSums>(sets.size())};
  for (const double frequency : block.frequency_hz)
    order.highest_frequency_hz = std::max(order.highest_frequency_hz, frequency);
  for (const RunFinder& p : part) {
    for (std::size_t i = 0; i < sets.size(); ++i) order.sums[i] += p.sums[i];
    for (const TiledRun& r : p.runs) {
      ++order.begin[r.tile + 1];
      order.samples[r.tile] += r.run.count;
    }
  }
  for (std::size_t tile = 0; tile < tiles; ++tile) order.begin[tile + 1] += order.begin[tile];
  order.run.resize(order.begin.back());
  std::vector<std::size_t> next(order.begin.begin(), order.begin.end() - 1);
  for (const RunFinder& p : part)
    for (const TiledRun& r : p.runs) order.run[next[r.tile]++] = r.run;
  return order;
}

}  // namespace misfit::imager
