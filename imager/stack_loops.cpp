#include "imager/stack_loops.h"

#include <algorithm>

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/stack_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/tap_vectors_internal.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The taps along w.
template <typename Real>
HWY_ATTR void evaluate(const TapTable<Real>& table, Real t, Real* out) {
  const hn::CappedTag<Real, 4> d;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(hn::CappedTag<Real, 4>()));
  const auto x = hn::Set(d, t);
  for (int k = 0; k < table.padded; k += lanes) {
    const Real* c = table.coefficient.data() + table.degree * table.padded + k;
    auto value = hn::LoadU(d, c);
    for (int power = table.degree - 1; power >= 0; --power) value = hn::MulAdd(value, x, hn::LoadU(d, c -= table.padded));
    hn::StoreU(value, d, out + k);
  }
}

template <typename Real, int Padded, int Components>
HWY_ATTR void spread_samples(const StackTaps<Real>& taps, const StackBatch<Real>& samples, StackBuffer<Real>& buffer) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  for (int i = 0; i < samples.count; ++i) {
    const T along_u(taps.u, samples.tu[i]);
    Real along_v[Padded];
    T(taps.v, samples.tv[i]).store(along_v);
    Real along_w[most_taps];
    evaluate(taps.w, samples.tw[i], along_w);
    const int first = std::max(0, samples.plane[i]);
    const int last = std::min(buffer.planes, samples.plane[i] + taps.w.width);
    for (int plane = first; plane < last; ++plane) {
      Real* cell = buffer.row(plane, samples.row[i], 0) + samples.column[i];
      Real value[Components];
      for (int c = 0; c < Components; ++c) value[c] = samples.value[c][i] * along_w[plane - samples.plane[i]];
      for (int j = 0; j < taps.v.width; ++j)
        for (int c = 0; c < Components; ++c, cell += buffer.columns) {
          const auto factor = hn::Set(d, along_v[j] * value[c]);
          for (int k = 0; k < T::vectors; ++k) {
            Real* at = cell + k * T::lanes;
            hn::StoreU(hn::MulAdd(factor, along_u.value[k], hn::LoadU(d, at)), d, at);
          }
        }
    }
  }
}

template <typename Real, int Padded>
HWY_ATTR void interpolate_samples(const StackTaps<Real>& taps, const StackBuffer<Real>& buffer, StackBatch<Real>& samples) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  for (int i = 0; i < samples.count; ++i) {
    const T along_u(taps.u, samples.tu[i]);
    Real along_v[Padded];
    T(taps.v, samples.tv[i]).store(along_v);
    Real along_w[most_taps];
    evaluate(taps.w, samples.tw[i], along_w);
    hn::Vec<typename T::Tag> real[T::vectors];
    hn::Vec<typename T::Tag> imaginary[T::vectors];
    for (int k = 0; k < T::vectors; ++k) real[k] = imaginary[k] = hn::Zero(d);
    const int first = std::max(0, samples.plane[i]);
    const int last = std::min(buffer.planes, samples.plane[i] + taps.w.width);
    for (int plane = first; plane < last; ++plane) {
      const Real* cell = buffer.row(plane, samples.row[i], 0) + samples.column[i];
      const Real height = along_w[plane - samples.plane[i]];
      for (int j = 0; j < taps.v.width; ++j, cell += 2 * buffer.columns) {
        const auto factor = hn::Set(d, height * along_v[j]);
        for (int k = 0; k < T::vectors; ++k) {
          real[k] = hn::MulAdd(factor, hn::LoadU(d, cell + k * T::lanes), real[k]);
          imaginary[k] = hn::MulAdd(factor, hn::LoadU(d, cell + buffer.columns + k * T::lanes), imaginary[k]);
        }
      }
    }
    auto real_sum = hn::Mul(real[0], along_u.value[0]);
    auto imaginary_sum = hn::Mul(imaginary[0], along_u.value[0]);
    for (int k = 1; k < T::vectors; ++k) {
      real_sum = hn::MulAdd(real[k], along_u.value[k], real_sum);
      imaginary_sum = hn::MulAdd(imaginary[k], along_u.value[k], imaginary_sum);
    }
    samples.value[0][i] = hn::GetLane(hn::SumOfLanes(d, real_sum));
    samples.value[1][i] = hn::GetLane(hn::SumOfLanes(d, imaginary_sum));
  }
}

template <typename Real, int Padded>
HWY_ATTR void spread_components(const StackTaps<Real>& taps, const StackBatch<Real>& samples, StackBuffer<Real>& buffer) {
  if (buffer.components == 4) return spread_samples<Real, Padded, 4>(taps, samples, buffer);
  spread_samples<Real, Padded, 2>(taps, samples, buffer);
}

template <typename Real>
HWY_ATTR void spread_any(const StackTaps<Real>& taps, const StackBatch<Real>& samples, StackBuffer<Real>& buffer) {
  switch (taps.u.padded) {
    case 4:
      return spread_components<Real, 4>(taps, samples, buffer);
    case 8:
      return spread_components<Real, 8>(taps, samples, buffer);
    case 12:
      return spread_components<Real, 12>(taps, samples, buffer);
    case 16:
      return spread_components<Real, 16>(taps, samples, buffer);
    default:
      return spread_components<Real, 20>(taps, samples, buffer);
  }
}

template <typename Real>
HWY_ATTR void interpolate_any(const StackTaps<Real>& taps, const StackBuffer<Real>& buffer, StackBatch<Real>& samples) {
  switch (taps.u.padded) {
    case 4:
      return interpolate_samples<Real, 4>(taps, buffer, samples);
    case 8:
      return interpolate_samples<Real, 8>(taps, buffer, samples);
    case 12:
      return interpolate_samples<Real, 12>(taps, buffer, samples);
    case 16:
      return interpolate_samples<Real, 16>(taps, buffer, samples);
    default:
      return interpolate_samples<Real, 20>(taps, buffer, samples);
  }
}

HWY_ATTR void stack_spread_float(const StackTaps<float>& t, const StackBatch<float>& s, StackBuffer<float>& b) {
  spread_any(t, s, b);
}
HWY_ATTR void stack_spread_double(const StackTaps<double>& t, const StackBatch<double>& s, StackBuffer<double>& b) {
  spread_any(t, s, b);
}
HWY_ATTR void stack_interpolate_float(const StackTaps<float>& t, const StackBuffer<float>& b, StackBatch<float>& s) {
  interpolate_any(t, b, s);
}
HWY_ATTR void stack_interpolate_double(const StackTaps<double>& t, const StackBuffer<double>& b, StackBatch<double>& s) {
  interpolate_any(t, b, s);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(stack_spread_float);
HWY_EXPORT(stack_spread_double);
HWY_EXPORT(stack_interpolate_float);
HWY_EXPORT(stack_interpolate_double);

void spread(const StackTaps<float>& taps, const StackBatch<float>& samples, StackBuffer<float>& buffer) {
  HWY_DYNAMIC_DISPATCH(stack_spread_float)(taps, samples, buffer);
}
void spread(const StackTaps<double>& taps, const StackBatch<double>& samples, StackBuffer<double>& buffer) {
  HWY_DYNAMIC_DISPATCH(stack_spread_double)(taps, samples, buffer);
}
void interpolate(const StackTaps<float>& taps, const StackBuffer<float>& buffer, StackBatch<float>& samples) {
  HWY_DYNAMIC_DISPATCH(stack_interpolate_float)(taps, buffer, samples);
}
void interpolate(const StackTaps<double>& taps, const StackBuffer<double>& buffer, StackBatch<double>& samples) {
  HWY_DYNAMIC_DISPATCH(stack_interpolate_double)(taps, buffer, samples);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
