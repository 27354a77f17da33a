#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <complex>

#include "imager/coplanar/tile_loops.h"
#include "imager/coplanar/tile_order.h"
#include "imager/coplanar/tile_positions.h"
#include "imager/data/geometry.h"
#include "imager/data/phase.h"
#include "imager/numerics/phasors.h"

namespace misfit::imager {

/// A tile, by its place in the grid and in a TileOrder.
struct TileTask {
  int tile_u;
  int tile_v;
  std::size_t tile;
};

/// The data of a batch's samples besides their places.
struct BatchSamples {
  static constexpr int capacity = TileBatch<double>::capacity;
  std::size_t index[capacity];  ///< row × channels + channel
  bool conjugate[capacity];     ///< whether the place is that of −u, −v
  bool off_phase_centre;        ///< otherwise there are no phasors
  double turns[capacity];       ///< u l_0 + v m_0
  double cosine[capacity];
  double sine[capacity];

  /// V exp(−2πi(u l_0 + v m_0)), of the sky seen from the image's middle pixel.
  std::complex<double> from_middle(std::complex<double> v, int k) const {
    if (!off_phase_centre) return v;
    return {v.real() * cosine[k] + v.imag() * sine[k], v.imag() * cosine[k] - v.real() * sine[k]};
  }
  /// The inverse, V exp(+2πi(u l_0 + v m_0)).
  std::complex<double> from_phase_centre(std::complex<double> v, int k) const {
    return std::conj(from_middle(std::conj(v), k));
  }
};

/// The origin of positions in a tile, see RowInTile.
struct TileOrigin {
  double u, v;

  TileOrigin(const GridShape& shape, const TileTask& task)
      : u(task.tile_u * shape.tile - shape.first_column(0) + 0.5 * shape.width - 1),
        v(task.tile_v * shape.tile - shape.first_row(0) + 0.5 * shape.width - 1) {}
};

/// One row of samples on its way into the batches of one tile.
class RowWalk {
 public:
  RowWalk(const FoldedRow& row, const GridShape& shape, const TileTask& task, double highest_frequency_hz)
      : row_(row), shape_(shape), within_(row.within(shape, highest_frequency_hz)), origin_(shape, task) {}

  /// Appends samples at up to `count` frequencies, as many as there is room for. Returns whether they are conjugated.
  template <typename Real>
  bool append(const double* frequency_hz, std::size_t count, TileBatch<Real>& batch) const {
    if (within_) {
      if (count == 1) {
        append_position({row_.u_per_hz, origin_.u, row_.v_per_hz, origin_.v, shape_.tile}, *frequency_hz, batch);
        return row_.folded;
      }
      const auto room = static_cast<std::size_t>(TileBatch<Real>::capacity - batch.count);
      append_positions({row_.u_per_hz, origin_.u, row_.v_per_hz, origin_.v, shape_.tile}, frequency_hz,
                       static_cast<int>(std::min(count, room)), batch);
      return row_.folded;
    }
    const PeriodicPosition at(row_.u_per_hz * *frequency_hz, row_.v_per_hz * *frequency_hz, row_.folded, shape_);
    append_position({at.u, origin_.u, at.v, origin_.v, shape_.tile}, 1, batch);
    return at.conjugate;
  }

 private:
  FoldedRow row_;
  const GridShape& shape_;
  bool within_;
  TileOrigin origin_;
};

/// Fills batches with the samples of one tile, and calls done(batch, samples) for each that is full.
template <typename Real, typename Done>
class BatchFiller {
 public:
  BatchFiller(const ImageGeometry& geometry, const GridShape& shape, const SampleCoordinates& at, const TileTask& task,
              const Done& done)
      : shape_(shape),
        at_(at),
        task_(task),
        scale_(shape, geometry),
        middle_{geometry.centre.l, geometry.centre.m, 0},
        done_(done) {
    samples_.off_phase_centre = geometry.off_phase_centre();
  }

  /// Adds channels of one row.
  void add_channels(const SampleRun& run, double highest_frequency_hz) {
    const double* const uvw_m = &at_.uvw_m[std::size_t{3} * run.row];
    const RowWalk row({uvw_m, scale_}, shape_, task_, highest_frequency_hz);
    const double to_middle = samples_.off_phase_centre ? turns_per_hz(uvw_m, middle_) : 0;
    const std::size_t end = std::size_t{run.first} + run.count;
    for (std::size_t channel = run.first; channel < end;) {
      const int begin = batch_.count;
      const bool conjugate = row.append(&at_.frequency_hz[channel], end - channel, batch_);
      for (int i = begin; i < batch_.count; ++i, ++channel) {
        samples_.index[i] = run.row * at_.channels() + channel;
        samples_.conjugate[i] = conjugate;
        samples_.turns[i] = to_middle * at_.frequency_hz[channel];
      }
      if (batch_.count == TileBatch<Real>::capacity) finish();
    }
  }

  /// Adds rows of one channel.
  void add_rows(const SampleRun& run) {
    const double frequency_hz = at_.frequency_hz.front();
    const TileOrigin origin(shape_, task_);
    const RowsInTile rows{scale_.u_cells_per_m_hz, scale_.v_cells_per_m_hz, frequency_hz, origin.u, origin.v, shape_.tile};
    const std::size_t end = std::size_t{run.row} + run.count;
    for (std::size_t row = run.row; row < end;) {
      const int begin = batch_.count;
      const auto room = static_cast<std::size_t>(TileBatch<Real>::capacity - begin);
      append_rows(rows, &at_.uvw_m[3 * row], static_cast<int>(std::min(end - row, room)), batch_, samples_.conjugate + begin);
      for (int i = begin; i < batch_.count; ++i, ++row) {
        samples_.index[i] = row;
        if (samples_.off_phase_centre) samples_.turns[i] = turns_per_hz(&at_.uvw_m[3 * row], middle_) * frequency_hz;
      }
      if (batch_.count == TileBatch<Real>::capacity) finish();
    }
  }

  /// Hands over the last batch.
  void finish() {
    if (batch_.count == 0) return;
    if (samples_.off_phase_centre) phasors(samples_.turns, batch_.count, samples_.cosine, samples_.sine);
    done_(batch_, samples_);
    batch_.count = 0;
  }

 private:
  const GridShape& shape_;
  const SampleCoordinates& at_;
  const TileTask& task_;
  CellScale scale_;
  PhasePosition middle_;
  const Done& done_;
  TileBatch<Real> batch_;
  BatchSamples samples_;
};

/// Walks through a tile's samples in batches: ahead(sample index) for the first of a run some time before done(batch, samples),
/// phasors computed, for the batches that hold it.
template <typename Real, typename Ahead, typename Done>
void for_each_batch(const ImageGeometry& geometry, const GridShape& shape, const SampleCoordinates& at, const TileOrder& order,
                    const TileTask& task, const Ahead& ahead, const Done& done) {
  constexpr std::size_t runs_ahead = 8;  // memory answers within the time that some runs take
  BatchFiller<Real, Done> filler(geometry, shape, at, task, done);
  for (std::size_t r = order.begin[task.tile]; r < order.begin[task.tile + 1]; ++r) {
    if (r + runs_ahead < order.run.size()) {
      const SampleRun later = order.run[r + runs_ahead];
      hwy::Prefetch(&at.uvw_m[std::size_t{3} * later.row]);
      ahead(later.row * at.channels() + later.first);
    }
    const SampleRun run = order.run[r];
    if (at.channels() == 1 && run.count > 1)
      filler.add_rows(run);
    else
      filler.add_channels(run, order.highest_frequency_hz);
  }
  filler.finish();
}

}  // namespace misfit::imager
