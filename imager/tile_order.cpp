#include "imager/tile_order.h"

#include <algorithm>
#include <stdexcept>

#include "imager/parallel.h"
#include "imager/sampling.h"

namespace misfit::imager {
namespace {

constexpr std::size_t chunks = 32;  // fixed, so that the order of sums does not depend on the number of threads
constexpr std::size_t longest_run = (1U << 12) - 1;
constexpr std::size_t most_channels = 1U << 20;

struct TiledRun {
  std::uint32_t tile;
  ChannelRun run;
};

/// The runs of a range of rows, in order.
class RunFinder {
 public:
  RunFinder(const VisibilityBlock& block, const std::vector<std::complex<double>>* visibility, const GridShape& shape,
            double cell_rad, Wanted wanted)
      : block_(block), visibility_(visibility), shape_(shape), scale_(shape, cell_rad), wanted_(wanted) {}

  void find(std::size_t begin_row, std::size_t end_row) {
    for (std::size_t row = begin_row; row < end_row; ++row) find_in_row(row);
  }

  std::vector<TiledRun> runs;
  SampleSums sums;

 private:
  void find_in_row(std::size_t row) {
    const FoldedRow folded(&block_.uvw_m[3 * row], scale_);
    const std::size_t channels = block_.channels();
    bool open = false;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      const double frequency = block_.frequency_hz[channel];
      if (!wants(row * channels + channel, folded.u_per_hz * frequency, folded.v_per_hz * frequency)) {
        open = false;
        continue;
      }
      const std::uint32_t tile = tile_of(folded, frequency);
      if (open && runs.back().tile == tile && runs.back().run.count < longest_run) {
        ++runs.back().run.count;
      } else {
        runs.push_back({tile, {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(channel) & 0xFFFFF, 1}});
      }
      open = true;
    }
  }

  bool wants(std::size_t sample, double u, double v) {
    if (wanted_ == Wanted::all) return true;
    const float weight = block_.weight[sample];
    if (weight == 0) return false;
    if (wanted_ == Wanted::usable) return true;
    if (!inside_grid(u / shape_.nu, v / shape_.nv)) {
      ++sums.outside_grid;
      return false;
    }
    ++sums.used;
    add_to_sums(sums, weight,
                visibility_ == nullptr ? std::complex<double>(block_.visibility[sample]) : (*visibility_)[sample]);
    return true;
  }

  std::uint32_t tile_of(const FoldedRow& row, double frequency) const {
    const PeriodicPosition at(row.u_per_hz * frequency, row.v_per_hz * frequency, row.folded, shape_);
    const int column = shape_.first_column(TapPosition(at.u, shape_.width).first) / shape_.tile;
    const int line = shape_.first_row(TapPosition(at.v, shape_.width).first) / shape_.tile;
    return static_cast<std::uint32_t>(line * shape_.tiles_u() + column);
  }

  const VisibilityBlock& block_;
  const std::vector<std::complex<double>>* visibility_;
  const GridShape& shape_;
  CellScale scale_;
  Wanted wanted_;
};

}  // namespace

TileOrder order_by_tile(const VisibilityBlock& block, const std::vector<std::complex<double>>* visibility,
                        const GridShape& shape, double cell_rad, Wanted wanted, int threads) {
  if (block.channels() > most_channels)
    throw std::invalid_argument(std::to_string(block.channels()) + " channels in one spectral window; at most " +
                                std::to_string(most_channels) + " are supported");
  std::vector<RunFinder> part(chunks, RunFinder(block, visibility, shape, cell_rad, wanted));
  parallel_for(chunks, threads,
               [&](std::size_t i) { part[i].find(block.rows() * i / chunks, block.rows() * (i + 1) / chunks); });

  const auto tiles = static_cast<std::size_t>(shape.tiles_u()) * static_cast<std::size_t>(shape.tiles_v());
  TileOrder order{std::vector<std::size_t>(tiles + 1), std::vector<std::size_t>(tiles), {}, {}};
  for (const RunFinder& p : part) {
    order.sums += p.sums;
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
