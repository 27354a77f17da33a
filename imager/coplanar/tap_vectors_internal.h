// Taps in vectors, for sources that Highway compiles once for every instruction set: this header is read each time anew.
#if defined(MISFIT_TAP_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef MISFIT_TAP_VECTORS
#undef MISFIT_TAP_VECTORS
#else
#define MISFIT_TAP_VECTORS
#endif

#include <hwy/highway.h>

#include "imager/coplanar/tap_table.h"

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// How W taps lie in memory and in vectors.
template <typename Real, int Width>
struct TapLanes {
  static constexpr int padded = padded_taps<Real>(Width);
  static constexpr int cap = padded % 16 == 0 ? 16 : padded % 8 == 0 ? 8 : 4;
  using Tag = hn::CappedTag<Real, cap>;
  using Vector = hn::Vec<Tag>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int vectors = (Width + lanes - 1) / lanes;
};

/// How `Padded` taps lie in vectors of the widest kind that divides them.
template <typename Real, int Padded>
struct Taps {
  static constexpr int cap = Padded % 16 == 0 ? 16 : Padded % 8 == 0 ? 8 : 4;
  using Tag = hn::CappedTag<Real, cap>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int vectors = Padded / lanes;
};

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
