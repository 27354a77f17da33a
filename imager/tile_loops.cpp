#include "imager/tile_loops.h"

#include <algorithm>
#include <utility>

#include "imager/batch_taps.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/tile_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/tap_vectors_internal.h"

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
  int end = begin + 1;
  while (end < samples.count && samples.column[end] == samples.column[begin] && samples.row[end] == samples.row[begin]) ++end;
  return {begin, end};
}

/// Adds `Rows` rows of the taps of samples in one cell: summed in registers, so that memory is touched once for all of them.
template <typename Real, int Width, int Planes, int Rows>
HWY_ATTR HWY_INLINE Real* add_rows(const TileBatch<Real>& samples, SameCell same, const Real* along_u, const Real* along_v,
                                   std::ptrdiff_t columns, Real* cell) {
  using T = TapLanes<Real, Width>;
  const typename T::Tag d;
  const Real* const value[3] = {samples.real, samples.imaginary, samples.weight};
  typename T::Vector sum[Rows][Planes][T::vectors];
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) sum[j][plane][k] = hn::Zero(d);
    }
  }
  for (int i = same.begin; i < same.end; ++i) {
    typename T::Vector term[Planes][T::vectors];
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
      const auto factor = hn::Set(d, value[plane][i]);
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) term[plane][k] =
          hn::Mul(factor, hn::Load(d, along_u + i * T::padded + k * T::lanes));
    }
    MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
      const auto factor = hn::Set(d, along_v[i * T::padded + j]);
      MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane) {
        MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) sum[j][plane][k] =
            hn::MulAdd(factor, term[plane][k], sum[j][plane][k]);
      }
    }
  }
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
    MISFIT_UNROLL for (int plane = 0; plane < Planes; ++plane, cell += columns) {
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
        Real* at = cell + k * T::lanes;
        hn::StoreU(hn::Add(sum[j][plane][k], hn::LoadU(d, at)), d, at);
      }
    }
  }
  return cell;
}

template <typename Real, int Width, int Planes>
HWY_ATTR void spread_samples(const TileBatch<Real>& samples, const Evaluated<Real>& along_u, const Evaluated<Real>& along_v,
                             TileBuffer<Real>& buffer) {
  constexpr int passes = (Width * Planes * TapLanes<Real, Width>::vectors + most_sums - 1) / most_sums;
  constexpr int rows = passes < Width ? (Width + passes - 1) / passes : 1;
  constexpr int rest = Width % rows;
  const std::ptrdiff_t columns = buffer.columns;
  for (SameCell same = next_cell(samples, 0); same.begin < samples.count; same = next_cell(samples, same.end)) {
    Real* cell = buffer.row(samples.row[same.begin], 0) + samples.column[same.begin];
    for (int j = 0; j < Width - rest; j += rows)
      cell = add_rows<Real, Width, Planes, rows>(samples, same, along_u.value, along_v.value + j, columns, cell);
    if constexpr (rest > 0)
      add_rows<Real, Width, Planes, rest>(samples, same, along_u.value, along_v.value + Width - rest, columns, cell);
  }
}

template <typename Real, int Width>
HWY_ATTR void interpolate_samples(const Evaluated<Real>& along_u, const Evaluated<Real>& along_v,
                                  const TileBuffer<Real>& buffer, TileBatch<Real>& samples) {
  using T = TapLanes<Real, Width>;
  const typename T::Tag d;
  const std::ptrdiff_t columns = buffer.columns;
  for (int i = 0; i < samples.count; ++i) {
    typename T::Vector real[T::vectors];
    typename T::Vector imaginary[T::vectors];
    MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) real[k] = imaginary[k] = hn::Zero(d);
    const Real* cell = buffer.cell.data() + samples.row[i] * 2 * columns + samples.column[i];
    MISFIT_UNROLL for (int j = 0; j < Width; ++j, cell += 2 * columns) {
      const auto factor = hn::Set(d, along_v.value[i * T::padded + j]);
      MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
        real[k] = hn::MulAdd(factor, hn::LoadU(d, cell + k * T::lanes), real[k]);
        imaginary[k] = hn::MulAdd(factor, hn::LoadU(d, cell + columns + k * T::lanes), imaginary[k]);
      }
    }
    auto real_sum = hn::Zero(d);
    auto imaginary_sum = hn::Zero(d);
    MISFIT_UNROLL for (int k = 0; k < T::vectors; ++k) {
      const auto taps = hn::Load(d, along_u.value + i * T::padded + k * T::lanes);
      real_sum = hn::MulAdd(real[k], taps, real_sum);
      imaginary_sum = hn::MulAdd(imaginary[k], taps, imaginary_sum);
    }
    samples.real[i] = hn::GetLane(hn::SumOfLanes(d, real_sum));
    samples.imaginary[i] = hn::GetLane(hn::SumOfLanes(d, imaginary_sum));
  }
}

template <typename Real, int... Before>
HWY_ATTR void spread_any(std::integer_sequence<int, Before...>, const TapTable<Real>& u, const TapTable<Real>& v,
                         const TileBatch<Real>& samples, TileBuffer<Real>& buffer) {
  Evaluated<Real> along_u, along_v;
  evaluate_taps(u, samples.tu, samples.count, along_u.value);
  evaluate_taps(v, samples.tv, samples.count, along_v.value);
  using Loop = void (*)(const TileBatch<Real>&, const Evaluated<Real>&, const Evaluated<Real>&, TileBuffer<Real>&);
  constexpr Loop two_planes[] = {spread_samples<Real, Before + 1, 2>...};
  constexpr Loop three_planes[] = {spread_samples<Real, Before + 1, 3>...};
  (buffer.planes == 3 ? three_planes : two_planes)[u.width - 1](samples, along_u, along_v, buffer);
}

template <typename Real, int... Before>
HWY_ATTR void interpolate_any(std::integer_sequence<int, Before...>, const TapTable<Real>& u, const TapTable<Real>& v,
                              const TileBuffer<Real>& buffer, TileBatch<Real>& samples) {
  Evaluated<Real> along_u, along_v;
  evaluate_taps(u, samples.tu, samples.count, along_u.value);
  evaluate_taps(v, samples.tv, samples.count, along_v.value);
  using Loop = void (*)(const Evaluated<Real>&, const Evaluated<Real>&, const TileBuffer<Real>&, TileBatch<Real>&);
  constexpr Loop loops[] = {interpolate_samples<Real, Before + 1>...};
  loops[u.width - 1](along_u, along_v, buffer, samples);
}

using Widths = std::make_integer_sequence<int, most_taps>;

HWY_ATTR void spread_float(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& s,
                           TileBuffer<float>& b) {
  spread_any(Widths(), u, v, s, b);
}
HWY_ATTR void spread_double(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& s,
                            TileBuffer<double>& b) {
  spread_any(Widths(), u, v, s, b);
}
HWY_ATTR void interpolate_float(const TapTable<float>& u, const TapTable<float>& v, const TileBuffer<float>& b,
                                TileBatch<float>& s) {
  interpolate_any(Widths(), u, v, b, s);
}
HWY_ATTR void interpolate_double(const TapTable<double>& u, const TapTable<double>& v, const TileBuffer<double>& b,
                                 TileBatch<double>& s) {
  interpolate_any(Widths(), u, v, b, s);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(spread_float);
HWY_EXPORT(spread_double);
HWY_EXPORT(interpolate_float);
HWY_EXPORT(interpolate_double);

void spread(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& samples, TileBuffer<float>& buffer) {
  HWY_DYNAMIC_DISPATCH(spread_float)(u, v, samples, buffer);
}
void spread(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& samples,
            TileBuffer<double>& buffer) {
  HWY_DYNAMIC_DISPATCH(spread_double)(u, v, samples, buffer);
}
void interpolate(const TapTable<float>& u, const TapTable<float>& v, const TileBuffer<float>& buffer,
                 TileBatch<float>& samples) {
  HWY_DYNAMIC_DISPATCH(interpolate_float)(u, v, buffer, samples);
}
void interpolate(const TapTable<double>& u, const TapTable<double>& v, const TileBuffer<double>& buffer,
                 TileBatch<double>& samples) {
  HWY_DYNAMIC_DISPATCH(interpolate_double)(u, v, buffer, samples);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
