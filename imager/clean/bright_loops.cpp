#include "imager/clean/bright_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/clean/bright_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, BrightRange::multiple>;

/// hn::Max of a number and NaN is its second argument on x86 and the number on Arm.
template <int terms>
HWY_ATTR float subtract_terms(const ReachingComponent* component, int components, const MeritForm& form,
                              const BrightRange& range) {
  const Tag d;
  const hn::RebindToSigned<Tag> of_offset;
  auto best = hn::Set(d, -1.0F);
  for (int i = 0; i < range.count; i += static_cast<int>(hn::Lanes(d))) {
    const auto offset = hn::LoadU(of_offset, range.offset + i);
    auto r0 = hn::LoadU(d, range.value[0] + i), r1 = r0, r2 = r0;
    if constexpr (terms > 1) r1 = hn::LoadU(d, range.value[1] + i);
    if constexpr (terms > 2) r2 = hn::LoadU(d, range.value[2] + i);
    for (int c = 0; c < components; ++c) {
      const ReachingComponent& of = component[c];
      const auto p0 = hn::GatherIndex(d, of.psf[0], offset);
      const auto i0 = hn::Set(d, of.coefficient[0]);
      r0 = hn::NegMulAdd(p0, i0, r0);
      if constexpr (terms > 1) {
        const auto p1 = hn::GatherIndex(d, of.psf[1], offset), p2 = hn::GatherIndex(d, of.psf[2], offset);
        const auto i1 = hn::Set(d, of.coefficient[1]);
        r0 = hn::NegMulAdd(p1, i1, r0);
        r1 = hn::NegMulAdd(p2, i1, hn::NegMulAdd(p1, i0, r1));
        if constexpr (terms > 2) {
          const auto p3 = hn::GatherIndex(d, of.psf[3], offset), p4 = hn::GatherIndex(d, of.psf[4], offset);
          const auto i2 = hn::Set(d, of.coefficient[2]);
          r0 = hn::NegMulAdd(p2, i2, r0);
          r1 = hn::NegMulAdd(p3, i2, r1);
          r2 = hn::NegMulAdd(p4, i2, hn::NegMulAdd(p3, i1, hn::NegMulAdd(p2, i0, r2)));
        }
      }
    }
    const auto y0 = hn::Mul(hn::Set(d, form.row[0][0]), r0);
    auto merit = hn::Mul(y0, y0);
    hn::StoreU(r0, d, range.value[0] + i);
    if constexpr (terms > 1) {
      const auto y1 = hn::MulAdd(hn::Set(d, form.row[1][0]), r0, hn::Mul(hn::Set(d, form.row[1][1]), r1));
      merit = hn::MulAdd(y1, y1, merit);
      hn::StoreU(r1, d, range.value[1] + i);
    }
    if constexpr (terms > 2) {
      const auto y2 = hn::MulAdd(hn::Set(d, form.row[2][0]), r0,
                                 hn::MulAdd(hn::Set(d, form.row[2][1]), r1, hn::Mul(hn::Set(d, form.row[2][2]), r2)));
      merit = hn::MulAdd(y2, y2, merit);
      hn::StoreU(r2, d, range.value[2] + i);
    }
    hn::StoreU(merit, d, range.merit + i);
    best = hn::Max(merit, best);
  }
  return hn::GetLane(hn::MaxOfLanes(d, best));
}

HWY_ATTR float subtract_any(const ReachingComponent* component, int components, const MeritForm& form, int terms,
                            const BrightRange& range) {
  if (terms == 1) return subtract_terms<1>(component, components, form, range);
  if (terms == 2) return subtract_terms<2>(component, components, form, range);
  return subtract_terms<3>(component, components, form, range);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(subtract_any);

float subtract(const ReachingComponent* component, int components, const MeritForm& form, int terms, const BrightRange& range) {
  return HWY_DYNAMIC_DISPATCH(subtract_any)(component, components, form, terms, range);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
