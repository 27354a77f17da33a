#include "imager/numerics/phasors.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/numerics/phasors.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "imager/numerics/phasor_vectors_internal.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename D>
HWY_ATTR void store_phasors(D d, const double* turns, double* cosine, double* sine) {
  hn::Vec<D> c, s;
  phasor_vector(d, hn::LoadU(d, turns), c, s);
  hn::StoreU(c, d, cosine);
  hn::StoreU(s, d, sine);
}

HWY_ATTR void phasors_all(const double* turns, int count, double* cosine, double* sine) {
  const hn::ScalableTag<double> wide;
  const int lanes = static_cast<int>(hn::Lanes(wide));
  int i = 0;
  for (; i + lanes <= count; i += lanes) store_phasors(wide, turns + i, cosine + i, sine + i);
  const hn::CappedTag<double, 1> one;
  for (; i < count; ++i) store_phasors(one, turns + i, cosine + i, sine + i);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(phasors_all);

void phasors(const double* turns, int count, double* cosine, double* sine) {
  HWY_DYNAMIC_DISPATCH(phasors_all)(turns, count, cosine, sine);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
