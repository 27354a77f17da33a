#include "imager/tile_loops.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/tile_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/tap_vectors_internal.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Real, int Padded, int Planes>
HWY_ATTR void spread_samples(const TapTable<Real>& u, const TapTable<Real>& v, const TileBatch<Real>& samples,
                             TileBuffer<Real>& buffer) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  for (int i = 0; i < samples.count; ++i) {
    const T along_u(u, samples.tu[i]);
    Real along_v[Padded];
    T(v, samples.tv[i]).store(along_v);
    const Real value[3] = {samples.real[i], samples.imaginary[i], samples.weight[i]};
    Real* cell = buffer.row(samples.row[i], 0) + samples.column[i];
    for (int j = 0; j < v.width; ++j) {
      for (int plane = 0; plane < Planes; ++plane) {
        const auto factor = hn::Set(d, along_v[j] * value[plane]);
        for (int k = 0; k < T::vectors; ++k) {
          Real* at = cell + k * T::lanes;
          hn::StoreU(hn::MulAdd(factor, along_u.value[k], hn::LoadU(d, at)), d, at);
        }
        cell += buffer.columns;
      }
    }
  }
}

template <typename Real, int Padded>
HWY_ATTR void interpolate_samples(const TapTable<Real>& u, const TapTable<Real>& v, const TileBuffer<Real>& buffer,
                                  TileBatch<Real>& samples) {
  using T = Taps<Real, Padded>;
  const typename T::Tag d;
  for (int i = 0; i < samples.count; ++i) {
    const T along_u(u, samples.tu[i]);
    Real along_v[Padded];
    T(v, samples.tv[i]).store(along_v);
    hn::Vec<typename T::Tag> real[T::vectors];
    hn::Vec<typename T::Tag> imaginary[T::vectors];
    for (int k = 0; k < T::vectors; ++k) real[k] = imaginary[k] = hn::Zero(d);
    const Real* cell = buffer.cell.data() + samples.row[i] * 2 * buffer.columns + samples.column[i];
    for (int j = 0; j < v.width; ++j, cell += 2 * buffer.columns) {
      const auto factor = hn::Set(d, along_v[j]);
      for (int k = 0; k < T::vectors; ++k) {
        real[k] = hn::MulAdd(factor, hn::LoadU(d, cell + k * T::lanes), real[k]);
        imaginary[k] = hn::MulAdd(factor, hn::LoadU(d, cell + buffer.columns + k * T::lanes), imaginary[k]);
      }
    }
    auto real_sum = hn::Mul(real[0], along_u.value[0]);
    auto imaginary_sum = hn::Mul(imaginary[0], along_u.value[0]);
    for (int k = 1; k < T::vectors; ++k) {
      real_sum = hn::MulAdd(real[k], along_u.value[k], real_sum);
      imaginary_sum = hn::MulAdd(imaginary[k], along_u.value[k], imaginary_sum);
    }
    samples.real[i] = hn::GetLane(hn::SumOfLanes(d, real_sum));
    samples.imaginary[i] = hn::GetLane(hn::SumOfLanes(d, imaginary_sum));
  }
}

template <typename Real, int Padded>
HWY_ATTR void spread_planes(const TapTable<Real>& u, const TapTable<Real>& v, const TileBatch<Real>& samples,
                            TileBuffer<Real>& buffer) {
  if (buffer.planes == 3) return spread_samples<Real, Padded, 3>(u, v, samples, buffer);
  spread_samples<Real, Padded, 2>(u, v, samples, buffer);
}

template <typename Real>
HWY_ATTR void spread_padded(const TapTable<Real>& u, const TapTable<Real>& v, const TileBatch<Real>& samples,
                            TileBuffer<Real>& buffer) {
  switch (u.padded) {
    case 4:
      return spread_planes<Real, 4>(u, v, samples, buffer);
    case 8:
      return spread_planes<Real, 8>(u, v, samples, buffer);
    case 12:
      return spread_planes<Real, 12>(u, v, samples, buffer);
    case 16:
      return spread_planes<Real, 16>(u, v, samples, buffer);
    default:
      return spread_planes<Real, 20>(u, v, samples, buffer);
  }
}

template <typename Real>
HWY_ATTR void interpolate_padded(const TapTable<Real>& u, const TapTable<Real>& v, const TileBuffer<Real>& buffer,
                                 TileBatch<Real>& samples) {
  switch (u.padded) {
    case 4:
      return interpolate_samples<Real, 4>(u, v, buffer, samples);
    case 8:
      return interpolate_samples<Real, 8>(u, v, buffer, samples);
    case 12:
      return interpolate_samples<Real, 12>(u, v, buffer, samples);
    case 16:
      return interpolate_samples<Real, 16>(u, v, buffer, samples);
    default:
      return interpolate_samples<Real, 20>(u, v, buffer, samples);
  }
}

HWY_ATTR void spread_float(const TapTable<float>& u, const TapTable<float>& v, const TileBatch<float>& s,
                           TileBuffer<float>& b) {
  spread_padded<float>(u, v, s, b);
}
HWY_ATTR void spread_double(const TapTable<double>& u, const TapTable<double>& v, const TileBatch<double>& s,
                            TileBuffer<double>& b) {
  spread_padded<double>(u, v, s, b);
}
HWY_ATTR void interpolate_float(const TapTable<float>& u, const TapTable<float>& v, const TileBuffer<float>& b,
                                TileBatch<float>& s) {
  interpolate_padded<float>(u, v, b, s);
}
HWY_ATTR void interpolate_double(const TapTable<double>& u, const TapTable<double>& v, const TileBuffer<double>& b,
                                 TileBatch<double>& s) {
  interpolate_padded<double>(u, v, b, s);
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
