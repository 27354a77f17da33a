#include "imager/coplanar/tile_loops.h"

#include <algorithm>
#include <utility>

#include "imager/coplanar/batch_taps.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/coplanar/tile_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/coplanar/tap_vectors_internal.h"

// Arrays of vectors stay in registers only where every loop over them is unrolled.
#undef MISFIT_UNROLL
#define MISFIT_UNROLL _Pragma("GCC unroll 64")

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Sums that a loop may keep in registers, leaving some for taps and factors.
constexpr int most_sums = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64 ? 26 : 13;

template <typename Real>
using Evaluated = BatchTaps<Real, TileBatch<Real>::capacity>;

/// Samples [begin, end) of a batch that all have their first tap in one cell.
struct SameCell {
  int begin;
  int end;
};

template <typename Real>
SameCell next_cell(const TileBatch<Real>& samples, int begin) {
  const int limit = std::min(samples.count, begin + most_in_registers);
  int end = begin + 1;
  while (end < limit && samples.column[end] == samples.column[begin] && samples.row[end] == samples.row[begin]) ++end;
  return {begin, end};
}

/// Some planes of a tile, and the values of a batch's samples for them.
template <typename Real, int Planes>
struct SomePlanes {
  const Real* value[Planes];  ///< [sample]
  Real* cell[Planes];         ///< row 0, column 0
  std::ptrdiff_t row;

  SomePlanes(const TileBatch<Real>& samples, const TileCells<Real>& cells, int first) : row(cells.row) {
    for (int plane = 0; plane < Planes; ++plane) {
      value[plane] = samples.value[first + plane];
      cell[plane] = cells.plane[first + plane];
    }
  }
};

/// Adds `Rows` rows of the taps of samples in one cell, from its row `first` on: summed in registers, so that memory is touched
/// once for all of them. `planes` is a copy since the compiler must take stores of vectors to reach anything else.
template <typename Real, int Width, int Planes, int Rows>
HWY_ATTR HWY_INLINE void add_rows(const TileBatch<Real>& samples, SameCell same, const Evaluated<Real>& u,
                                  const Evaluated<Real>& v, int first, SomePlanes<Real, Planes> planes) {
  using T = TapLanes<Real, Width>;
  const typename T::Tag d;
  typename T::Vector sum[Rows][Planes][T::vectors];
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) sum[j][plane][k] = hn::Zero(d);
    }
  }
  for (int i = same.begin; i < same.end; ++i) {
    typename T::Vector term[Planes][T::vectors];
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
      const auto factor = hn::Set(d, planes.value[plane][i]);
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) term[plane][k] =
          hn::Mul(factor, hn::Load(d, u.value + i * T::padded + k * T::lanes));
    }
    MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
      const auto factor = hn::Set(d, v.value[i * T::padded + first + j]);
      MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
        MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) sum[j][plane][k] =
            hn::MulAdd(factor, term[plane][k], sum[j][plane][k]);
      }
    }
  }
  std::ptrdiff_t start = (samples.row[same.begin] + first) * planes.row + samples.column[same.begin];
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j, start += planes.row) {
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
      Real* const cell = planes.cell[plane] + start;
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
        Real* at = cell + k * T::lanes;
        hn::StoreU(hn::Add(sum[j][plane][k], hn::LoadU(d, at)), d, at);
      }
    }
  }
}

template <typename Real, int Width, int Planes>
HWY_ATTR void spread_samples(const TileBatch<Real>& samples, const Evaluated<Real>& along_u, const Evaluated<Real>& along_v,
                             const TileCells<Real>& cells, int first_plane) {
  const SomePlanes<Real, Planes> planes(samples, cells, first_plane);
  constexpr int passes = (Width * Planes * TapLanes<Real, Width>::vectors + most_sums - 1) / most_sums;
  constexpr int rows = passes < Width ? (Width + passes - 1) / passes : 1;
  constexpr int rest = Width % rows;
  for (SameCell same = next_cell(samples, 0); same.begin < samples.count; same = next_cell(samples, same.end)) {
    for (int j = 0; j < Width - rest; j += rows)
      add_rows<Real, Width, Planes, rows>(samples, same, along_u, along_v, j, planes);
    if constexpr (rest > 0) add_rows<Real, Width, Planes, rest>(samples, same, along_u, along_v, Width - rest, planes);
  }
}

/// Sets the values of two planes, the first and the one that follows it.
template <typename Real, int Width>
HWY_ATTR void interpolate_samples(const Evaluated<Real>& along_u, const Evaluated<Real>& along_v,
                                  const TileCells<const Real>& cells, int first_plane, TileBatch<Real>& samples) {
  using T = TapLanes<Real, Width>;
  const typename T::Tag d;
  for (int i = 0; i < samples.count; ++i) {
    typename T::Vector real[T::vectors];
    typename T::Vector imaginary[T::vectors];
    MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) real[k] = imaginary[k] = hn::Zero(d);
    const std::ptrdiff_t start = samples.row[i] * cells.row + samples.column[i];
    const Real *real_cell = cells.plane[first_plane] + start, *imaginary_cell = cells.plane[first_plane + 1] + start;
    MISFIT_UNROLL for (int j = 0; j < Width; ++j, real_cell += cells.row, imaginary_cell += cells.row) {
      const auto factor = hn::Set(d, along_v.value[i * T::padded + j]);
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
        real[k] = hn::MulAdd(factor, hn::LoadU(d, real_cell + k * T::lanes), real[k]);
        imaginary[k] = hn::MulAdd(factor, hn::LoadU(d, imaginary_cell + k * T::lanes), imaginary[k]);
      }
    }
    auto real_sum = hn::Zero(d);
    auto imaginary_sum = hn::Zero(d);
    MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
      const auto taps = hn::Load(d, along_u.value + i * T::padded + k * T::lanes);
      real_sum = hn::MulAdd(real[k], taps, real_sum);
      imaginary_sum = hn::MulAdd(imaginary[k], taps, imaginary_sum);
    }
    samples.value[first_plane][i] = hn::GetLane(hn::SumOfLanes(d, real_sum));
    samples.value[first_plane + 1][i] = hn::GetLane(hn::SumOfLanes(d, imaginary_sum));
  }
}

template <typename Real, int... Before>
HWY_ATTR void spread_any(std::integer_sequence<int, Before...>, const TapTable<Real>& u, const TapTable<Real>& v,
                         const TileBatch<Real>& samples, const TileCells<Real>& cells) {
  Evaluated<Real> along_u, along_v;
  evaluate_taps(u, samples.tu, samples.count, along_u.value);
  evaluate_taps(v, samples.tv, samples.count, along_v.value);
  using Loop = void (*)(const TileBatch<Real>&, const Evaluated<Real>&, const Evaluated<Real>&, const TileCells<Real>&, int);
  constexpr Loop one_plane[] = {spread_samples<Real, Before + 1, 1>...};
  constexpr Loop two_planes[] = {spread_samples<Real, Before + 1, 2>...};
  constexpr Loop three_planes[] = {spread_samples<Real, Before + 1, 3>...};
  for (int plane = 0; plane < cells.planes;) {
    const int left = cells.planes - plane, some = left == 1 ? 1 : left == 2 || left == 4 ? 2 : 3;
    (some == 1 ? one_plane : some == 2 ? two_planes : three_planes)[u.width - 1](samples, along_u, along_v, cells, plane);
    plane += some;
  }
}

template <typename Real, int... Before>
HWY_ATTR void interpolate_any(std::integer_sequence<int, Before...>, const TapTable<Real>& u, const TapTable<Real>& v,
                              const TileCells<const Real>& cells, TileBatch<Real>& samples) {
  Evaluated<Real> along_u, along_v;
  evaluate_taps(u, samples.tu, samples.count, along_u.value);
  evaluate_taps(v, samples.tv, samples.count, along_v.value);
  using Loop = void (*)(const Evaluated<Real>&, const Evaluated<Real>&, const TileCells<const Real>&, int, TileBatch<Real>&);
  constexpr Loop loops[] = {interpolate_samples<Real, Before + 1>...};
  for (int plane = 0; plane + 1 < cells.planes; plane += 2) loops[u.width - 1](along_u, along_v, cells, plane, samples);
}

using Widths = std::make_integer_sequence<int, most_taps>;

HWY_ATTR void spread_float(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& s,
                           const TileCells<float>& c) {
  spread_any(Widths(), u, v, s, c);
}
HWY_ATTR void spread_double(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& s,
                            const TileCells<double>& c) {
  spread_any(Widths(), u, v, s, c);
}
HWY_ATTR void interpolate_float(const TapTable<float>& u, const TapTable<float>& v, const TileCells<const float>& c,
                                TileBatch<float>& s) {
  interpolate_any(Widths(), u, v, c, s);
}
HWY_ATTR void interpolate_double(const TapTable<double>& u, const TapTable<double>& v, const TileCells<const double>& c,
                                 TileBatch<double>& s) {
  interpolate_any(Widths(), u, v, c, s);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(spread_float);
HWY_EXPORT(spread_double);
HWY_EXPORT(interpolate_float);
HWY_EXPORT(interpolate_double);

void spread(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& samples,
            const TileCells<float>& cells) {
  HWY_DYNAMIC_DISPATCH(spread_float)(u, v, samples, cells);
}
void spread(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& samples,
            const TileCells<double>& cells) {
  HWY_DYNAMIC_DISPATCH(spread_double)(u, v, samples, cells);
}
void interpolate(const TapTable<float>& u, const TapTable<float>& v, const TileCells<const float>& cells,
                 TileBatch<float>& samples) {
  HWY_DYNAMIC_DISPATCH(interpolate_float)(u, v, cells, samples);
}
void interpolate(const TapTable<double>& u, const TapTable<double>& v, const TileCells<const double>& cells,
                 TileBatch<double>& samples) {
  HWY_DYNAMIC_DISPATCH(interpolate_double)(u, v, cells, samples);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
