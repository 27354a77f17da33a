#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <complex>

#include "imager/geometry.h"
#include "imager/phase.h"
#include "imager/phasors.h"
#include "imager/plane/tile_loops.h"
#include "imager/plane/tile_order.h"
#include "imager/plane/tile_positions.h"

namespace misfit::imager {

/// A tile, by its place in the grid and in a TileOrder.
struct TileTask {
  int tile_u;
  int tile_v;
  std::size_t tile;
};

/// What a batch needs to know of its samples besides their places.
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

/// One row of samples on its way into the batches of one tile.
class RowWalk {
 public:
  RowWalk(const FoldedRow& row, const GridShape& shape, const TileTask& task, double highest_frequency_hz)
      : row_(row),
        shape_(shape),
        within_(row.within(shape, highest_frequency_hz)),
        u_origin_(task.tile_u * shape.tile - shape.first_column(0) + 0.5 * shape.width - 1),
        v_origin_(task.tile_v * shape.tile - shape.first_row(0) + 0.5 * shape.width - 1) {}

  /// Appends samples at up to `count` frequencies, as many as there is room for. Returns whether they are conjugated.
  template <typename Real>
  bool append(const double* frequency_hz, std::size_t count, TileBatch<Real>& batch) const {
    if (within_) {
      if (count == 1) {
        append_position({row_.u_per_hz, u_origin_, row_.v_per_hz, v_origin_, shape_.tile}, *frequency_hz, batch);
        return row_.folded;
      }
      const auto room = static_cast<std::size_t>(TileBatch<Real>::capacity - batch.count);
      append_positions({row_.u_per_hz, u_origin_, row_.v_per_hz, v_origin_, shape_.tile}, frequency_hz,
                       static_cast<int>(std::min(count, room)), batch);
      return row_.folded;
    }
    const PeriodicPosition at(row_.u_per_hz * *frequency_hz, row_.v_per_hz * *frequency_hz, row_.folded, shape_);
    append_position({at.u, u_origin_, at.v, v_origin_, shape_.tile}, 1, batch);
    return at.conjugate;
  }

 private:
  FoldedRow row_;
  const GridShape& shape_;
  bool within_;
  double u_origin_;  ///< see RowInTile
  double v_origin_;
};

/// Walks through a tile's samples in batches: ahead(sample index) for the first of a run some time before done(batch, samples),
/// phasors computed, for the batches that hold it.
template <typename Real, typename Ahead, typename Done>
void for_each_batch(const ImageGeometry& geometry, const GridShape& shape, const SampleCoordinates& at, const TileOrder& order,
                    const TileTask& task, const Ahead& ahead, const Done& done) {
  constexpr std::size_t runs_ahead = 8;  // memory answers within the time that some runs take
  const CellScale scale(shape, geometry.cell_rad);
  const PhasePosition middle{geometry.centre.l, geometry.centre.m, 0};
  TileBatch<Real> batch;
  BatchSamples samples;
  samples.off_phase_centre = geometry.off_phase_centre();
  const auto finish = [&] {
    if (samples.off_phase_centre) phasors(samples.turns, batch.count, samples.cosine, samples.sine);
    done(batch, samples);
    batch.count = 0;
  };
  for (std::size_t r = order.begin[task.tile]; r < order.begin[task.tile + 1]; ++r) {
    if (r + runs_ahead < order.run.size()) {
      const ChannelRun later = order.run[r + runs_ahead];
      hwy::Prefetch(&at.uvw_m[std::size_t{3} * later.row]);
      ahead(later.row * at.channels() + later.first);
    }
    const ChannelRun run = order.run[r];
    const double* uvw_m = &at.uvw_m[std::size_t{3} * run.row];
    const RowWalk row({uvw_m, scale}, shape, task, order.highest_frequency_hz);
    const double to_middle = turns_per_hz(uvw_m, middle);
    const std::size_t end = std::size_t{run.first} + run.count;
    for (std::size_t channel = run.first; channel < end;) {
      const int begin = batch.count;
      const bool conjugate = row.append(&at.frequency_hz[channel], end - channel, batch);
      for (int i = begin; i < batch.count; ++i, ++channel) {
        samples.index[i] = run.row * at.channels() + channel;
        samples.conjugate[i] = conjugate;
        samples.turns[i] = to_middle * at.frequency_hz[channel];
      }
      if (batch.count == TileBatch<Real>::capacity) finish();
    }
  }
  if (batch.count > 0) finish();
}

}  // namespace misfit::imager
