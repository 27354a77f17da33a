#include "imager/coplanar/batch_taps.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/coplanar/batch_taps.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/coplanar/tap_vectors_internal.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Horner's rule for `Samples` samples in step: the processor works on the others while one waits for its product.
template <typename Real, int Padded, int Samples>
HWY_ATTR HWY_INLINE void evaluate_in_step(const TapTable<Real>& table, const Real* t, Real* out) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  hn::Vec<typename T::Tag> value[Samples][T::vectors];
  const Real* c = table.coefficient.data() + table.degree * Padded;
  for (int k = 0; k < T::vectors; ++k)
    for (int s = 0; s < Samples; ++s) value[s][k] = hn::LoadU(d, c + k * T::lanes);
  for (int power = table.degree - 1; power >= 0; --power) {
    c -= Padded;
    for (int k = 0; k < T::vectors; ++k) {
      const auto coefficient = hn::LoadU(d, c + k * T::lanes);
      for (int s = 0; s < Samples; ++s) value[s][k] = hn::MulAdd(value[s][k], hn::Set(d, t[s]), coefficient);
    }
  }
  for (int s = 0; s < Samples; ++s)
    for (int k = 0; k < T::vectors; ++k) hn::Store(value[s][k], d, out + s * Padded + k * T::lanes);
}

template <typename Real, int Padded, int Degree>
HWY_ATTR void look_up(const TapTable<Real>& table, const Real* t, int count, Real* out) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  const Real* const mirrored = table.entry.data() + table.entry.size() / 2;
  for (int i = 0; i < count; ++i, out += Padded) {
    const auto [k, p] = kernels::LookupTable<Real>::place_in(*table.lookup, table.last, t[i]);
    const Real* entry = (t[i] < 0 ? mirrored : table.entry.data()) + static_cast<std::ptrdiff_t>(k) * Padded;
    const auto weight = kernels::newton_weights<Real, Degree>(p);
    for (int v = 0; v < T::vectors; ++v, entry += T::lanes) {
      auto sum = hn::Mul(hn::Set(d, weight[0]), hn::LoadU(d, entry));
      for (int j = 1; j <= Degree; ++j)
        sum = hn::MulAdd(hn::Set(d, weight[static_cast<std::size_t>(j)]), hn::LoadU(d, entry + j * Padded), sum);
      hn::Store(sum, d, out + v * T::lanes);
    }
  }
}

template <typename Real, int Padded>
HWY_ATTR void look_up_padded(const TapTable<Real>& table, const Real* t, int count, Real* out) {
  switch (table.lookup->interpolation) {
    case kernels::Interpolation::nearest:
      return look_up<Real, Padded, 0>(table, t, count, out);
    case kernels::Interpolation::linear:
      return look_up<Real, Padded, 1>(table, t, count, out);
    case kernels::Interpolation::quadratic:
      return look_up<Real, Padded, 2>(table, t, count, out);
    case kernels::Interpolation::cubic:
      return look_up<Real, Padded, 3>(table, t, count, out);
  }
}

template <typename Real, int Padded>
HWY_ATTR void evaluate_padded(const TapTable<Real>& table, const Real* t, int count, Real* out) {
  if (table.lookup) return look_up_padded<Real, Padded>(table, t, count, out);
  constexpr int samples = Taps<Real, Padded>::vectors == 1 ? 8 : Taps<Real, Padded>::vectors <= 4 ? 4 : 1;
  int i = 0;
  for (; i + samples <= count; i += samples) evaluate_in_step<Real, Padded, samples>(table, t + i, out + i * Padded);
  for (; i < count; ++i) evaluate_in_step<Real, Padded, 1>(table, t + i, out + i * Padded);
}

template <typename Real>
HWY_ATTR void evaluate_any(const TapTable<Real>& table, const Real* t, int count, Real* out) {
  switch (table.padded) {
    case 4:
      return evaluate_padded<Real, 4>(table, t, count, out);
    case 8:
      return evaluate_padded<Real, 8>(table, t, count, out);
    case 12:
      return evaluate_padded<Real, 12>(table, t, count, out);
    case 16:
      return evaluate_padded<Real, 16>(table, t, count, out);
    default:
      return evaluate_padded<Real, 20>(table, t, count, out);
  }
}

HWY_ATTR void evaluate_float(const TapTable<float>& table, const float* t, int count, float* out) {
  evaluate_any(table, t, count, out);
}
HWY_ATTR void evaluate_double(const TapTable<double>& table, const double* t, int count, double* out) {
  evaluate_any(table, t, count, out);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(evaluate_float);
HWY_EXPORT(evaluate_double);

void evaluate_taps(const TapTable<float>& table, const float* t, int count, float* out) {
  HWY_DYNAMIC_DISPATCH(evaluate_float)(table, t, count, out);
}
void evaluate_taps(const TapTable<double>& table, const double* t, int count, double* out) {
  HWY_DYNAMIC_DISPATCH(evaluate_double)(table, t, count, out);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
