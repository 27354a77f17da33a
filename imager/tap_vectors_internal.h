// Taps in vectors, for sources that Highway compiles once for every instruction set: this header is read each time anew.
#if defined(MISFIT_TAP_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef MISFIT_TAP_VECTORS
#undef MISFIT_TAP_VECTORS
#else
#define MISFIT_TAP_VECTORS
#endif

#include <hwy/highway.h>

#include "imager/tap_table.h"

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

/// `Padded` taps as vectors of the widest kind that divides them.
template <typename Real, int Padded>
struct Taps {
  static constexpr int cap = Padded % 16 == 0 ? 16 : Padded % 8 == 0 ? 8 : 4;
  using Tag = hn::CappedTag<Real, cap>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int vectors = Padded / lanes;
  hn::Vec<Tag> value[vectors];

  /// Σ_d coefficient_d t^d for all taps at once.
  HWY_ATTR Taps(const TapTable<Real>& table, Real t) {
    const Tag d;
    const auto x = hn::Set(d, t);
    const Real* c = table.coefficient.data() + table.degree * Padded;
    for (int k = 0; k < vectors; ++k) value[k] = hn::LoadU(d, c + k * lanes);
    for (int power = table.degree - 1; power >= 0; --power) {
      c -= Padded;
      for (int k = 0; k < vectors; ++k) value[k] = hn::MulAdd(value[k], x, hn::LoadU(d, c + k * lanes));
    }
  }
  HWY_ATTR void store(Real* out) const {
    for (int k = 0; k < vectors; ++k) hn::StoreU(value[k], Tag(), out + k * lanes);
  }
};

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
