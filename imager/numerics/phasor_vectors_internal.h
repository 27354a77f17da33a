// Phasors in vectors, for sources that Highway compiles once for every instruction set: this header is read each time anew.
#if defined(MISFIT_PHASOR_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef MISFIT_PHASOR_VECTORS
#undef MISFIT_PHASOR_VECTORS
#else
#define MISFIT_PHASOR_VECTORS
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// cosine + i sine = exp(2πi turns): Taylor series on an eighth of a turn to either side, where the first term left out is
/// below half a unit of rounding.
template <typename D, typename V = hn::Vec<D>>
HWY_INLINE HWY_ATTR void phasor_vector(D d, V turns, V& cosine, V& sine) {
  const auto turn = hn::Sub(turns, hn::Round(turns));                // [−½, ½]
  const auto quarter = hn::Round(hn::Mul(turn, hn::Set(d, 4.0)));    // −2 … 2
  const auto rest = hn::NegMulAdd(quarter, hn::Set(d, 0.25), turn);  // [−⅛, ⅛], exact
  const auto angle = hn::Mul(rest, hn::Set(d, 6.28318530717958647692));
  const auto square = hn::Mul(angle, angle);
  constexpr double sine_term[] = {-1.0 / 6,          1.0 / 120,          -1.0 / 5040,           1.0 / 362880,
                                  -1.0 / 39916800.0, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
  constexpr double cosine_term[] = {-1.0 / 2,         1.0 / 24,          -1.0 / 720,           1.0 / 40320,
                                    -1.0 / 3628800.0, 1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  auto s = hn::Set(d, sine_term[6]);
  for (int i = 5; i >= 0; --i) s = hn::MulAdd(s, square, hn::Set(d, sine_term[i]));
  s = hn::MulAdd(hn::Mul(s, square), angle, angle);
  auto c = hn::Set(d, cosine_term[7]);
  for (int i = 6; i >= 0; --i) c = hn::MulAdd(c, square, hn::Set(d, cosine_term[i]));
  c = hn::MulAdd(c, square, hn::Set(d, 1.0));
  // exp(i(angle + quarter π/2)): swapped for odd quarters, negated for half turns.
  const auto magnitude = hn::Abs(quarter);
  const auto odd = hn::Eq(magnitude, hn::Set(d, 1.0));
  const auto half = hn::Eq(magnitude, hn::Set(d, 2.0));
  const auto direction = hn::IfThenElse(half, hn::Set(d, -1.0), quarter);  // ±1 where it matters
  const auto even_factor = hn::IfThenElse(half, hn::Set(d, -1.0), hn::Set(d, 1.0));
  cosine = hn::IfThenElse(odd, hn::Neg(hn::Mul(direction, s)), hn::Mul(even_factor, c));
  sine = hn::IfThenElse(odd, hn::Mul(direction, c), hn::Mul(even_factor, s));
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
