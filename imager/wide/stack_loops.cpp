#include "imager/wide/stack_loops.h"

#include <algorithm>
#include <utility>

#include "imager/coplanar/batch_taps.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/wide/stack_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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

/// Samples whose taps a plane holds, plane by plane: a plane of the buffer fits the nearest cache where all of them do not.
/// visit(plane, sample, tap along w).
template <typename Real, typename Visit>
HWY_ATTR HWY_INLINE void for_each_plane(const StackTaps<Real>& taps, const StackBatch<Real>& samples, const Along<Real>& along,
                                        int planes, const Visit& visit) {
  constexpr int stride = 16;  // neighbouring channels fall on each other's cells, and would wait for each other
  if (samples.count == 0) return;
  const auto [lowest, highest] = std::minmax_element(samples.plane, samples.plane + samples.count);
  const int begin = std::max(0, *lowest), end = std::min(planes, *highest + taps.w.width);
  for (int plane = begin; plane < end; ++plane)
    for (int first = 0; first < stride; ++first)
      for (int i = first; i < samples.count; i += stride) {
        const int tap = plane - samples.plane[i];
        if (tap >= 0 && tap < taps.w.width) visit(plane, i, along.w.value[i * taps.w.padded + tap]);
      }
}

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

/// To `Grids` grids from `first_grid` on.
template <typename Real, int Vectors, int Grids>
HWY_ATTR void spread_samples(const StackTaps<Real>& taps, const StackBatch<Real>& samples, const Along<Real>& along,
                             const StackCells<std::complex<Real>>& cells, int first_grid) {
  const Tag<Real> d;
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
  const std::ptrdiff_t line = 2 * cells.row;
  const auto add = [&](const Real* taps_u, Real along_w, const Real* along_v, Real* cell) HWY_ATTR {
    const auto height = hn::Set(d, along_w);
    hn::Vec<Tag<Real>> term[Vectors];
    for (int k = 0; k < Vectors; ++k) term[k] = hn::Mul(height, hn::LoadU(d, taps_u + k * lanes));
    for (int j = 0; j < width; ++j, cell += line) {
      const auto factor = hn::Set(d, along_v[j]);
      for (int k = 0; k < Vectors; ++k)
        hn::StoreU(hn::MulAdd(factor, term[k], hn::LoadU(d, cell + k * lanes)), d, cell + k * lanes);
    }
  };
  for_each_plane(taps, samples, along, cells.planes, [&](int plane, int i, Real along_w) HWY_ATTR {
    const Real* v = along.v.value + i * taps.v.padded;
    const bool crosses = numbers_within(samples.column[i], width, cells.columns) < 2 * width;
    for (int g = 0; g < Grids; ++g) {
      std::complex<Real>* group =
          cells.first + plane * cells.plane + samples.row[i] * cells.row + (first_grid + g) * cells.grid;
      add(row[i][g].whole, along_w, v, reinterpret_cast<Real*>(group + samples.column[i]));
      if (crosses) add(row[i][g].beyond, along_w, v, reinterpret_cast<Real*>(group + cells.next));
    }
  });
}

template <typename Real, int Vectors>
HWY_ATTR void interpolate_samples(const StackTaps<Real>& taps, const StackCells<const std::complex<Real>>& cells,
                                  StackBatch<Real>& samples) {
  const Tag<Real> d;
  constexpr int lanes = lanes_of<Real>, numbers = Vectors * lanes;
  const int width = taps.v.width;
  const Along<Real> along(taps, samples);
  alignas(64) Halves<Real, numbers> row[TilePlaces<Real>::capacity];  // Σ C_v C_w · cell
  for (int i = 0; i < samples.count; ++i) {
    std::fill_n(row[i].whole, numbers, Real(0));
    std::fill_n(row[i].beyond, numbers, Real(0));
  }
  const std::ptrdiff_t line = 2 * cells.row;
  const auto add = [&](const Real* cell, Real along_w, const Real* along_v, Real* sums) HWY_ATTR {
    hn::Vec<Tag<Real>> sum[Vectors];
    for (int k = 0; k < Vectors; ++k) sum[k] = hn::Zero(d);
    for (int j = 0; j < width; ++j, cell += line) {
      const auto factor = hn::Set(d, along_v[j]);
      for (int k = 0; k < Vectors; ++k) sum[k] = hn::MulAdd(factor, hn::LoadU(d, cell + k * lanes), sum[k]);
    }
    const auto height = hn::Set(d, along_w);
    for (int k = 0; k < Vectors; ++k)
      hn::StoreU(hn::MulAdd(height, sum[k], hn::LoadU(d, sums + k * lanes)), d, sums + k * lanes);
  };
  for_each_plane(taps, samples, along, cells.planes, [&](int plane, int i, Real along_w) HWY_ATTR {
    const Real* v = along.v.value + i * taps.v.padded;
    const std::complex<Real>* group = cells.first + plane * cells.plane + samples.row[i] * cells.row;
    add(reinterpret_cast<const Real*>(group + samples.column[i]), along_w, v, row[i].whole);
    if (numbers_within(samples.column[i], width, cells.columns) < 2 * width)
      add(reinterpret_cast<const Real*>(group + cells.next), along_w, v, row[i].beyond);
  });
  const TapsTag<Real> dt;
  for (int i = 0; i < samples.count; ++i) {
    const int within = numbers_within(samples.column[i], width, cells.columns);
    if (within < 2 * width) std::copy_n(row[i].beyond, numbers - within, row[i].whole + within);
    auto real_sum = hn::Zero(dt), imaginary_sum = real_sum;
    for (int k = 0; k < numbers / 2; k += taps_at_once<Real>) {
      const auto u = hn::LoadU(dt, along.u.value + i * taps.u.padded + k);
      hn::Vec<TapsTag<Real>> real, imaginary;
      hn::LoadInterleaved2(dt, row[i].whole + 2 * k, real, imaginary);
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
HWY_ATTR void add_any(const std::complex<Real>* from, int count, std::complex<Real>* to) {
  const hn::ScalableTag<Real> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Real* in = reinterpret_cast<const Real*>(from);
  Real* out = reinterpret_cast<Real*>(to);
  int i = 0;
  for (; i + lanes <= 2 * count; i += lanes) hn::StoreU(hn::Add(hn::LoadU(d, in + i), hn::LoadU(d, out + i)), d, out + i);
  for (; i < 2 * count; ++i) out[i] += in[i];
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
HWY_ATTR void stack_add_float(const std::complex<float>* from, int count, std::complex<float>* to) {
  add_any(from, count, to);
}
HWY_ATTR void stack_add_double(const std::complex<double>* from, int count, std::complex<double>* to) {
  add_any(from, count, to);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(stack_spread_float);
HWY_EXPORT(stack_spread_double);
HWY_EXPORT(stack_interpolate_float);
HWY_EXPORT(stack_interpolate_double);
HWY_EXPORT(stack_add_float);
HWY_EXPORT(stack_add_double);

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
void add_cells(const std::complex<float>* from, int count, std::complex<float>* to) {
  HWY_DYNAMIC_DISPATCH(stack_add_float)(from, count, to);
}
void add_cells(const std::complex<double>* from, int count, std::complex<double>* to) {
  HWY_DYNAMIC_DISPATCH(stack_add_double)(from, count, to);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
