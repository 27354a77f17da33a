#include "imager/direct/source_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/direct/source_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Read anew for each instruction set, so they come after what names it.
#include <hwy/contrib/math/math-inl.h>

#include "imager/numerics/phasor_vectors_internal.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, RowGroup::rows>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t lanes = hn::MaxLanes(Tag());
static_assert(SourceArrays::together == 2);

/// A vector of rows.
struct Rows {
  Vector u, v, w;
};

/// A source on its way along the channels of some rows: its phasor now and at the next channel.
struct Wave {
  Vector real, imaginary, next_real, next_imaginary;
  Vector twice_cosine;  ///< of a step
};

/// The factor of a Gaussian, its ratio to the next one, and the ratio of ratios.
struct Fall {
  Vector value, ratio, ratio_of_ratios;
};

HWY_ATTR HWY_INLINE Wave wave_of(const SourceArrays& sources, std::size_t source, const Rows& rows,
                                 const EvenChannels& channels) {
  const Tag d;
  const auto turns_per_hz =
      hn::MulAdd(rows.w, hn::Set(d, sources.n_minus_1[source]),
                 hn::MulAdd(rows.v, hn::Set(d, sources.m[source]), hn::Mul(rows.u, hn::Set(d, sources.l[source]))));
  const auto flux = hn::Set(d, sources.flux_jy[source]);
  Wave wave{};
  phasor_vector(d, hn::Mul(turns_per_hz, hn::Set(d, channels.first_hz)), wave.real, wave.imaginary);
  wave.real = hn::Mul(wave.real, flux);
  wave.imaginary = hn::Mul(wave.imaginary, flux);
  if (channels.count == 1) return wave;
  Vector cosine, sine;
  phasor_vector(d, hn::Mul(turns_per_hz, hn::Set(d, channels.step_hz)), cosine, sine);
  wave.next_real = hn::NegMulAdd(wave.imaginary, sine, hn::Mul(wave.real, cosine));
  wave.next_imaginary = hn::MulAdd(wave.imaginary, cosine, hn::Mul(wave.real, sine));
  wave.twice_cosine = hn::Add(cosine, cosine);
  return wave;
}

HWY_ATTR HWY_INLINE void step(Wave& wave) {
  const auto real = hn::MulSub(wave.twice_cosine, wave.next_real, wave.real);
  const auto imaginary = hn::MulSub(wave.twice_cosine, wave.next_imaginary, wave.imaginary);
  wave.real = wave.next_real;
  wave.imaginary = wave.next_imaginary;
  wave.next_real = real;
  wave.next_imaginary = imaginary;
}

/// exp(−decay (u² + v²)) along the channels; 0 where it begins below the smallest that counts, so that nothing is denormal.
HWY_ATTR HWY_INLINE Fall fall_of(Vector decay_s2, const EvenChannels& channels) {
  const Tag d;
  const double f = channels.first_hz, step_hz = channels.step_hz;
  const auto exponent = hn::Mul(decay_s2, hn::Set(d, -f * f));
  const auto counts = hn::Ge(exponent, hn::Set(d, -largest_decay));
  Fall fall{};
  fall.value = hn::IfThenElseZero(counts, hn::Exp(d, exponent));
  if (channels.count == 1) return fall;
  const auto falling = hn::IfThenElseZero(counts, decay_s2);
  fall.ratio = hn::Exp(d, hn::Mul(falling, hn::Set(d, -step_hz * (2 * f + step_hz))));
  fall.ratio_of_ratios = hn::Exp(d, hn::Mul(falling, hn::Set(d, -2 * step_hz * step_hz)));
  return fall;
}

HWY_ATTR HWY_INLINE void step(Fall& fall) {
  fall.value = hn::Mul(fall.value, fall.ratio);
  fall.ratio = hn::Mul(fall.ratio, fall.ratio_of_ratios);
}

HWY_ATTR HWY_INLINE Rows rows_of(const RowGroup& group, std::size_t lane) {
  const Tag d;
  return {hn::LoadU(d, &group.u_s[lane]), hn::LoadU(d, &group.v_s[lane]), hn::LoadU(d, &group.w_s[lane])};
}

HWY_ATTR void add_points_to(const SourceArrays& sources, SourceRange range, const RowGroup& group, const EvenChannels& channels,
                            GroupSums& sums) {
  const Tag d;
  for (std::size_t lane = 0; lane < RowGroup::rows; lane += lanes) {
    const Rows rows = rows_of(group, lane);
    for (std::size_t s = range.begin; s < range.end; s += 2) {
      Wave a = wave_of(sources, s, rows, channels), b = wave_of(sources, s + 1, rows, channels);
      for (std::size_t i = lane; i < lane + channels.count * RowGroup::rows; i += RowGroup::rows) {
        double* const real = &sums.real[i];
        double* const imaginary = &sums.imaginary[i];
        hn::StoreU(hn::Add(hn::LoadU(d, real), hn::Add(a.real, b.real)), d, real);
        hn::StoreU(hn::Add(hn::LoadU(d, imaginary), hn::Add(a.imaginary, b.imaginary)), d, imaginary);
        step(a);
        step(b);
      }
    }
  }
}

HWY_ATTR void add_gaussians_to(const SourceArrays& sources, SourceRange range, const RowGroup& group,
                               const EvenChannels& channels, GroupSums& sums) {
  const Tag d;
  for (std::size_t lane = 0; lane < RowGroup::rows; lane += lanes) {
    const Rows rows = rows_of(group, lane);
    const auto baseline2 = hn::MulAdd(rows.u, rows.u, hn::Mul(rows.v, rows.v));
    for (std::size_t s = range.begin; s < range.end; s += 2) {
      Fall f = fall_of(hn::Mul(baseline2, hn::Set(d, sources.decay[s])), channels);
      Fall g = fall_of(hn::Mul(baseline2, hn::Set(d, sources.decay[s + 1])), channels);
      if (hn::AllTrue(d, hn::Eq(hn::Max(f.value, g.value), hn::Zero(d)))) continue;
      Wave a = wave_of(sources, s, rows, channels), b = wave_of(sources, s + 1, rows, channels);
      for (std::size_t i = lane; i < lane + channels.count * RowGroup::rows; i += RowGroup::rows) {
        double* const real = &sums.real[i];
        double* const imaginary = &sums.imaginary[i];
        hn::StoreU(hn::MulAdd(f.value, a.real, hn::MulAdd(g.value, b.real, hn::LoadU(d, real))), d, real);
        hn::StoreU(hn::MulAdd(f.value, a.imaginary, hn::MulAdd(g.value, b.imaginary, hn::LoadU(d, imaginary))), d, imaginary);
        step(a);
        step(b);
        step(f);
        step(g);
      }
    }
  }
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(add_points_to);
HWY_EXPORT(add_gaussians_to);

void add_points(const SourceArrays& sources, SourceRange range, const RowGroup& rows, const EvenChannels& channels,
                GroupSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_points_to)(sources, range, rows, channels, sums);
}
void add_gaussians(const SourceArrays& sources, SourceRange range, const RowGroup& rows, const EvenChannels& channels,
                   GroupSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_gaussians_to)(sources, range, rows, channels, sums);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
