#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <vector>

#include "imager/numerics/phasors.h"
#include "imager/wide/stack_loops.h"
#include "imager/wide/stack_order.h"

namespace misfit::imager {

/// Neighbouring planes.
struct StackPlanes {
  int first = 0;
  int planes = 0;
};

/// Planes `first` … first + pairs − 1 and the opposite ones, which a stack holds at a time, from the lowest to the highest.
struct Slab {
  int first = 0;
  int pairs = 0;

  /// The one or two ranges of planes that it consists of.
  std::vector<StackPlanes> ranges() const {
    if (first == 0) return {{-pairs, 2 * pairs}};
    return {{-first - pairs, pairs}, {first, pairs}};
  }
  /// The place of a plane in the stack.
  int place(int plane) const { return plane < 0 ? plane + first + pairs : plane - first + pairs; }
};

/// A tile's runs that reach into a slab, and the planes of it that they touch.
struct StackTask {
  int tile_u;
  int tile_v;
  std::size_t begin;
  std::size_t end;
  StackPlanes planes;
};

/// The pairs of planes that hold anything, in slabs of at most `most_pairs`.
std::vector<Slab> slabs_of(const StackOrder& order, int most_pairs);

/// Neighbouring rows of tiles, [begin, end).
struct Band {
  int begin = 0;
  int end = 0;
};

/// All rows of tiles, in bands of so many.
std::vector<Band> bands_of(const StackShape& shape, int tiles);

/// A band's tasks in four colours of tiles whose buffers cannot touch, the fullest of a colour first; for each of the slab's
/// ranges of planes, since a sample may touch both.
std::vector<std::vector<StackTask>> tasks_of(const StackOrder& order, const StackShape& shape, const Slab& slab, int width_w,
                                             const Band& band);

/// Neighbouring channels of a row in a batch.
struct BatchRun {
  std::uint32_t block;
  std::size_t sample;  ///< row × channels + channel of the first
  int begin;           ///< place in the batch
  int end;
  bool mirrored;
};

/// The data of a batch's samples besides their places.
struct BatchPhases {
  static constexpr int capacity = TilePlaces<double>::capacity;
  int most;  ///< samples of the batches to come
  std::vector<BatchRun> run;
  double turns[capacity];  ///< of the facet's middle pixel
  double cosine[capacity];
  double sine[capacity];
};

/// A facet's samples and their order.
struct StackSamples {
  const std::vector<WantedSamples>& blocks;
  const StackOrder& order;
  const StackOrderOptions& ordering;
};

/// Walks through a task's samples in batches: ahead(block, first sample, last) of a run some time before done(batch, phases),
/// phases computed, for the batches that hold it. Batches have up to `most` samples, which done may change.
template <typename Real, typename Ahead, typename Done>
void for_each_batch(const StackSamples& samples, const StackTask& task, const Ahead& ahead, const Done& done,
                    int most = BatchPhases::capacity) {
  constexpr std::size_t runs_ahead = 8;  // memory answers within the time that some runs take
  const StackShape& shape = samples.ordering.shape;
  const double half_width_w = 0.5 * samples.ordering.width_w;
  StackBatch<Real> batch;
  BatchPhases phases;
  phases.most = most;
  const auto finish = [&] {
    phasors(phases.turns, batch.count, phases.cosine, phases.sine);
    done(batch, phases);
    batch.count = 0;
    phases.run.clear();
  };
  for (std::size_t r = task.begin; r < task.end; ++r) {
    if (r + runs_ahead < task.end) {
      const StackRun later = samples.order.run[r + runs_ahead];
      const SampleCoordinates& at = *samples.blocks[later.block].at;
      hwy::Prefetch(&at.uvw_m[std::size_t{3} * later.row]);
      const std::size_t first = later.row * at.channels() + later.first;
      ahead(later.block, first, first + later.count - 1);
    }
    const StackRun run = samples.order.run[r];
    const SampleCoordinates& at = *samples.blocks[run.block].at;
    const StackRow row(&at.uvw_m[std::size_t{3} * run.row], run.mirrored != 0, samples.ordering.scale);
    const double* frequency_hz = &at.frequency_hz[run.first];
    const RowInTile in_tile = row_in_tile(row, shape, task.tile_u, task.tile_v, *frequency_hz);
    const double first_w = run.plane + half_width_w;
    const int count = run.count;
    for (int c = 0; c < count;) {
      const int begin = batch.count, some = std::min(count - c, phases.most - begin);
      append_positions(in_tile, frequency_hz + c, some, batch);
      for (int i = 0; i < some; ++i) {
        batch.plane[begin + i] = run.plane - task.planes.first;
        batch.tw[begin + i] = static_cast<Real>(row.w_per_hz * frequency_hz[c + i] - first_w);
        phases.turns[begin + i] = row.turns_per_hz * frequency_hz[c + i];
      }
      const std::size_t sample = run.row * at.channels() + run.first + static_cast<std::size_t>(c);
      phases.run.push_back({run.block, sample, begin, begin + some, run.mirrored != 0});
      c += some;
      if (batch.count == phases.most) finish();
    }
  }
  if (batch.count > 0) finish();
}

}  // namespace misfit::imager
