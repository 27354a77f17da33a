#include "imager/wide/stack_loops.h"

#include <algorithm>
#include <utility>

#include "imager/coplanar/batch_taps.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/wide/stack_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Arrays of vectors stay in registers only where every loop over them is unrolled.
#undef MISFIT_UNROLL
#define MISFIT_UNROLL _Pragma("GCC unroll 64")

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Real and imaginary parts lie in turn, so that a vector holds half as many cells as numbers.
template <typename Real>
using Tag = hn::CappedTag<Real, 32 / sizeof(Real)>;
template <typename Real>
constexpr int lanes_of = static_cast<int>(hn::MaxLanes(Tag<Real>()));

/// Vectors that hold the taps of a row.
template <typename Real>
constexpr int vectors_of(int width) {
  return (2 * width + lanes_of<Real> - 1) / lanes_of<Real>;
}

template <typename Real>
using Evaluated = BatchTaps<Real, TilePlaces<Real>::capacity>;

/// A batch's taps: [sample][padded].
template <typename Real>
struct Along {
  Evaluated<Real> u, v, w;

  Along(const StackTaps<Real>& taps, const StackBatch<Real>& samples) {
    evaluate_taps(taps.u, samples.tu, samples.count, u.value);
    evaluate_taps(taps.v, samples.tv, samples.count, v.value);
    evaluate_taps(taps.w, samples.tw, samples.count, w.value);
  }
};

/// As many taps as a vector holds complex numbers.
template <typename Real>
using TapsTag = hn::CappedTag<Real, lanes_of<Real> == 1 ? 1 : lanes_of<Real> / 2>;
template <typename Real>
constexpr int taps_at_once = static_cast<int>(hn::MaxLanes(TapsTag<Real>()));

/// The taps along w, [begin, end), of a sample that lie within the planes.
struct TapsWithin {
  int begin;
  int end;

  TapsWithin(int plane, int width, int planes) : begin(std::max(0, -plane)), end(std::min(width, planes - plane)) {}
};

/// A sample's taps along u in the two groups of columns that they may lie in.
template <typename Real, int Numbers>
struct Halves {
  Real whole[Numbers];  ///< of the first group alone where they cross over
  Real beyond[Numbers];
};

/// How many of the taps' numbers lie within `columns`, from `column` on.
HWY_INLINE int numbers_within(int column, int width, int columns) {
  return 2 * std::min(width, columns - column);
}

/// Samples [begin, end) of a batch whose first taps share a cell and a plane.
struct SameCell {
  int begin;
  int end;
};

template <typename Real>
HWY_INLINE SameCell next_cell(const StackBatch<Real>& samples, int begin) {
  int end = begin + 1;
  while (end < samples.count && samples.column[end] == samples.column[begin] && samples.row[end] == samples.row[begin] &&
         samples.plane[end] == samples.plane[begin])
    ++end;
  return {begin, end};
}

/// Samples' value · C_u for one or two grids, and their taps along the other axes: [sample], a stride apart.
template <typename Real>
struct TapRows {
  const Real* u;
  int stride_u;
  int grid_u;  ///< from one grid to the next
  const Real* v;
  int stride_v;
  const Real* w;
  int stride_w;
};

/// Adds `Rows` rows of the taps of some samples of one cell in one plane, summed in registers, so that memory is touched once
/// for all of them.
template <typename Real, int Vectors, int Grids, int Rows>
HWY_ATTR HWY_INLINE void add_rows(const TapRows<Real>& taps, int samples, Real* cell, std::ptrdiff_t line,
                                  std::ptrdiff_t grid) {
  const Tag<Real> d;
  constexpr int lanes = lanes_of<Real>;
  hn::Vec<Tag<Real>> sum[Rows][Grids][Vectors];
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
    MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
      MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) sum[j][g][k] = hn::LoadU(d, cell + j * line + g * grid + k * lanes);
    }
  }
  const Real *u = taps.u, *v = taps.v, *w = taps.w;
  for (int i = 0; i < samples; ++i, u += taps.stride_u, v += taps.stride_v, w += taps.stride_w) {
    const auto height = hn::Set(d, *w);
    hn::Vec<Tag<Real>> term[Grids][Vectors];
    MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
      MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) term[g][k] =
          hn::Mul(height, hn::LoadU(d, u + g * taps.grid_u + k * lanes));
    }
    MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
      const auto factor = hn::Set(d, v[j]);
      MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
        MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) sum[j][g][k] = hn::MulAdd(factor, term[g][k], sum[j][g][k]);
      }
    }
  }
  MISFIT_UNROLL for (int j = 0; j < Rows; ++j) {
    MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
      MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) hn::StoreU(sum[j][g][k], d, cell + j * line + g * grid + k * lanes);
    }
  }
}

/// Adds the taps of one sample in one plane, row after row.
template <typename Real, int Vectors, int Grids>
HWY_ATTR HWY_INLINE void add_sample(const TapRows<Real>& taps, int width, Real* cell, std::ptrdiff_t line,
                                    std::ptrdiff_t grid) {
  const Tag<Real> d;
  constexpr int lanes = lanes_of<Real>;
  hn::Vec<Tag<Real>> term[Grids][Vectors];
  const auto height = hn::Set(d, *taps.w);
  MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
    MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) term[g][k] =
        hn::Mul(height, hn::LoadU(d, taps.u + g * taps.grid_u + k * lanes));
  }
  for (const Real *v = taps.v, *const end = v + width; v != end; ++v, cell += line) {
    const auto factor = hn::Set(d, *v);
    MISFIT_UNROLL for (int g = 0; g < Grids; ++g) {
      MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) {
        Real* const at = cell + g * grid + k * lanes;
        hn::StoreU(hn::MulAdd(factor, term[g][k], hn::LoadU(d, at)), d, at);
      }
    }
  }
}

/// Sums that fit the registers beside a sample's terms.
constexpr int most_sums = 12;

template <typename Real, int Vectors, int Grids>
HWY_ATTR HWY_INLINE void add_plane(TapRows<Real> taps, int samples, int width, Real* cell, std::ptrdiff_t line,
                                   std::ptrdiff_t grid) {
  if (samples == 1) return add_sample<Real, Vectors, Grids>(taps, width, cell, line, grid);
  constexpr int rows = std::clamp(most_sums / (Vectors * Grids), 1, 4);
  int j = 0;
  for (; j + rows <= width; j += rows, taps.v += rows, cell += rows * line)
    add_rows<Real, Vectors, Grids, rows>(taps, samples, cell, line, grid);
  switch (width - j) {
    case 1:
      return add_rows<Real, Vectors, Grids, 1>(taps, samples, cell, line, grid);
    case 2:
      return add_rows<Real, Vectors, Grids, std::min(rows, 2)>(taps, samples, cell, line, grid);
    case 3:
      return add_rows<Real, Vectors, Grids, std::min(rows, 3)>(taps, samples, cell, line, grid);
    default:
      return;
  }
}

/// Spreads samples to `Grids` grids from `first_grid` on.
template <typename Real, int Vectors, int Grids>
HWY_ATTR void spread_samples(const StackTaps<Real>& taps, const StackBatch<Real>& samples, const Along<Real>& along,
                             const StackCells<std::complex<Real>>& cells, int first_grid) {
  const TapsTag<Real> dt;
  constexpr int lanes = lanes_of<Real>, numbers = Vectors * lanes;
  const int width = taps.v.width;
  alignas(64) Halves<Real, numbers> row[TilePlaces<Real>::capacity][Grids];  // value · C_u
  for (int i = 0; i < samples.count; ++i) {
    const int within = numbers_within(samples.column[i], width, cells.columns);
    for (int g = 0; g < Grids; ++g) {
      Real* const whole = row[i][g].whole;
      const std::complex<Real> value = samples.value[first_grid + g][i];
      for (int k = 0; k < numbers / 2; k += taps_at_once<Real>) {
        const auto u = hn::LoadU(dt, along.u.value + i * taps.u.padded + k);
        hn::StoreInterleaved2(hn::Mul(u, hn::Set(dt, value.real())), hn::Mul(u, hn::Set(dt, value.imag())), dt, whole + 2 * k);
      }
      if (within == 2 * width) continue;
      std::fill(std::copy(whole + within, whole + numbers, row[i][g].beyond), row[i][g].beyond + numbers, Real(0));
      std::fill(whole + within, whole + numbers, Real(0));
    }
  }
  // Cell by cell, and each cell plane by plane: the next one's sums wait for none that are still on their way to memory.
  for (SameCell same = next_cell(samples, 0); same.begin < samples.count; same = next_cell(samples, same.end)) {
    const int i = same.begin, count = same.end - same.begin;
    const bool crosses = numbers_within(samples.column[i], width, cells.columns) < 2 * width;
    const TapsWithin within(samples.plane[i], taps.w.width, cells.planes);
    for (int tap = within.begin; tap < within.end; ++tap) {
      TapRows<Real> rows{row[i][0].whole,
                         Grids * sizeof(Halves<Real, numbers>) / sizeof(Real),
                         sizeof(Halves<Real, numbers>) / sizeof(Real),
                         along.v.value + i * taps.v.padded,
                         taps.v.padded,
                         along.w.value + i * taps.w.padded + tap,
                         taps.w.padded};
      std::complex<Real>* const group =
          cells.first + (samples.plane[i] + tap) * cells.plane + samples.row[i] * cells.row + first_grid * cells.grid;
      add_plane<Real, Vectors, Grids>(rows, count, width, reinterpret_cast<Real*>(group + samples.column[i]), 2 * cells.row,
                                      2 * cells.grid);
      if (!crosses) continue;
      rows.u = row[i][0].beyond;
      add_plane<Real, Vectors, Grids>(rows, count, width, reinterpret_cast<Real*>(group + cells.next), 2 * cells.row,
                                      2 * cells.grid);
    }
  }
}

/// A sample's taps along v, and those along w that lie within the planes.
template <typename Real>
struct HeightTaps {
  const Real* v;
  int width;
  const Real* w;
  int planes;
};

/// sums = Σ C_v C_w · cell, from the first tap's cell on.
template <typename Real, int Vectors>
HWY_ATTR HWY_INLINE void sum_rows(const HeightTaps<Real>& taps, const StackCells<const std::complex<Real>>& cells,
                                  const std::complex<Real>* first, Real* sums) {
  const Tag<Real> d;
  constexpr int lanes = lanes_of<Real>;
  hn::Vec<Tag<Real>> sum[Vectors];
  MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) sum[k] = hn::Zero(d);
  for (int tap = 0; tap < taps.planes; ++tap, first += cells.plane) {
    const Real* cell = reinterpret_cast<const Real*>(first);
    hn::Vec<Tag<Real>> of_plane[Vectors];
    MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) of_plane[k] = hn::Zero(d);
    for (int j = 0; j < taps.width; ++j, cell += 2 * cells.row) {
      const auto factor = hn::Set(d, taps.v[j]);
      MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) of_plane[k] =
          hn::MulAdd(factor, hn::LoadU(d, cell + k * lanes), of_plane[k]);
    }
    const auto height = hn::Set(d, taps.w[tap]);
    MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) sum[k] = hn::MulAdd(height, of_plane[k], sum[k]);
  }
  MISFIT_UNROLL for (int k = 0; k < Vectors; ++k) hn::StoreU(sum[k], d, sums + k * lanes);
}

template <typename Real, int Vectors>
HWY_ATTR void interpolate_samples(const StackTaps<Real>& taps, const StackCells<const std::complex<Real>>& cells,
                                  StackBatch<Real>& samples) {
  constexpr int numbers = Vectors * lanes_of<Real>;
  const int width = taps.v.width;
  const Along<Real> along(taps, samples);
  const TapsTag<Real> dt;
  for (int i = 0; i < samples.count; ++i) {
    alignas(64) Halves<Real, numbers> row;
    const TapsWithin along_w(samples.plane[i], taps.w.width, cells.planes);
    const HeightTaps<Real> height{along.v.value + i * taps.v.padded, width, along.w.value + i * taps.w.padded + along_w.begin,
                                  along_w.end - along_w.begin};
    const std::complex<Real>* group =
        cells.first + (samples.plane[i] + along_w.begin) * cells.plane + samples.row[i] * cells.row;
    sum_rows<Real, Vectors>(height, cells, group + samples.column[i], row.whole);
    const int within = numbers_within(samples.column[i], width, cells.columns);
    if (within < 2 * width) {
      sum_rows<Real, Vectors>(height, cells, group + cells.next, row.beyond);
      std::copy_n(row.beyond, numbers - within, row.whole + within);
    }
    auto real_sum = hn::Zero(dt), imaginary_sum = real_sum;
    for (int k = 0; k < numbers / 2; k += taps_at_once<Real>) {
      const auto u = hn::LoadU(dt, along.u.value + i * taps.u.padded + k);
      hn::Vec<TapsTag<Real>> real, imaginary;
      hn::LoadInterleaved2(dt, row.whole + 2 * k, real, imaginary);
      real_sum = hn::MulAdd(real, u, real_sum);
      imaginary_sum = hn::MulAdd(imaginary, u, imaginary_sum);
    }
    samples.value[0][i] = {hn::GetLane(hn::SumOfLanes(dt, real_sum)), hn::GetLane(hn::SumOfLanes(dt, imaginary_sum))};
  }
}

template <typename Real, int... Before>
HWY_ATTR void spread_any(std::integer_sequence<int, Before...>, const StackTaps<Real>& taps, const StackBatch<Real>& samples,
                         const StackCells<std::complex<Real>>& cells) {
  using Loop =
      void (*)(const StackTaps<Real>&, const StackBatch<Real>&, const Along<Real>&, const StackCells<std::complex<Real>>&, int);
  constexpr Loop one_grid[] = {spread_samples<Real, Before + 1, 1>...};
  constexpr Loop two_grids[] = {spread_samples<Real, Before + 1, 2>...};
  const Along<Real> along(taps, samples);
  for (int grid = 0; grid < cells.grids; grid += 2)
    (cells.grids - grid > 1 ? two_grids : one_grid)[vectors_of<Real>(taps.u.width) - 1](taps, samples, along, cells, grid);
}

template <typename Real, int... Before>
HWY_ATTR void interpolate_any(std::integer_sequence<int, Before...>, const StackTaps<Real>& taps,
                              const StackCells<const std::complex<Real>>& cells, StackBatch<Real>& samples) {
  using Loop = void (*)(const StackTaps<Real>&, const StackCells<const std::complex<Real>>&, StackBatch<Real>&);
  constexpr Loop loops[] = {interpolate_samples<Real, Before + 1>...};
  loops[vectors_of<Real>(taps.u.width) - 1](taps, cells, samples);
}

template <typename Real>
using VectorCounts = std::make_integer_sequence<int, vectors_of<Real>(most_taps)>;

template <typename Real>
HWY_ATTR void move_any(std::complex<Real>* from, int count, std::complex<Real>* to) {
  const hn::ScalableTag<Real> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  Real* in = reinterpret_cast<Real*>(from);
  Real* out = reinterpret_cast<Real*>(to);
  int i = 0;
  for (; i + lanes <= 2 * count; i += lanes) {
    hn::StoreU(hn::Add(hn::LoadU(d, in + i), hn::LoadU(d, out + i)), d, out + i);
    hn::StoreU(hn::Zero(d), d, in + i);
  }
  for (; i < 2 * count; ++i) {
    out[i] += in[i];
    in[i] = 0;
  }
}

HWY_ATTR void stack_spread_float(const StackTaps<float>& t, const StackBatch<float>& s,
                                 const StackCells<std::complex<float>>& b) {
  spread_any(VectorCounts<float>(), t, s, b);
}
HWY_ATTR void stack_spread_double(const StackTaps<double>& t, const StackBatch<double>& s,
                                  const StackCells<std::complex<double>>& b) {
  spread_any(VectorCounts<double>(), t, s, b);
}
HWY_ATTR void stack_interpolate_float(const StackTaps<float>& t, const StackCells<const std::complex<float>>& b,
                                      StackBatch<float>& s) {
  interpolate_any(VectorCounts<float>(), t, b, s);
}
HWY_ATTR void stack_interpolate_double(const StackTaps<double>& t, const StackCells<const std::complex<double>>& b,
                                       StackBatch<double>& s) {
  interpolate_any(VectorCounts<double>(), t, b, s);
}
HWY_ATTR void stack_move_float(std::complex<float>* from, int count, std::complex<float>* to) {
  move_any(from, count, to);
}
HWY_ATTR void stack_move_double(std::complex<double>* from, int count, std::complex<double>* to) {
  move_any(from, count, to);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(stack_spread_float);
HWY_EXPORT(stack_spread_double);
HWY_EXPORT(stack_interpolate_float);
HWY_EXPORT(stack_interpolate_double);
HWY_EXPORT(stack_move_float);
HWY_EXPORT(stack_move_double);

void spread(const StackTaps<float>& taps, const StackBatch<float>& samples, const StackCells<std::complex<float>>& cells) {
  HWY_DYNAMIC_DISPATCH(stack_spread_float)(taps, samples, cells);
}
void spread(const StackTaps<double>& taps, const StackBatch<double>& samples, const StackCells<std::complex<double>>& cells) {
  HWY_DYNAMIC_DISPATCH(stack_spread_double)(taps, samples, cells);
}
void interpolate(const StackTaps<float>& taps, const StackCells<const std::complex<float>>& cells, StackBatch<float>& samples) {
  HWY_DYNAMIC_DISPATCH(stack_interpolate_float)(taps, cells, samples);
}
void interpolate(const StackTaps<double>& taps, const StackCells<const std::complex<double>>& cells,
                 StackBatch<double>& samples) {
  HWY_DYNAMIC_DISPATCH(stack_interpolate_double)(taps, cells, samples);
}
void move_cells(std::complex<float>* from, int count, std::complex<float>* to) {
  HWY_DYNAMIC_DISPATCH(stack_move_float)(from, count, to);
}
void move_cells(std::complex<double>* from, int count, std::complex<double>* to) {
  HWY_DYNAMIC_DISPATCH(stack_move_double)(from, count, to);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
