#include "imager/transform/span_sums.h"

#include "imager/transform/sampling.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/transform/span_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Floats = hn::Rebind<float, Doubles>;
using Vector = hn::Vec<Doubles>;

HWY_ATTR HWY_INLINE Vector squares(const std::complex<float>* z) {
  hn::Vec<Floats> real, imaginary;
  hn::LoadInterleaved2(Floats(), reinterpret_cast<const float*>(z), real, imaginary);
  const Vector re = hn::PromoteTo(Doubles(), real), im = hn::PromoteTo(Doubles(), imaginary);
  return hn::MulAdd(re, re, hn::Mul(im, im));
}

HWY_ATTR HWY_INLINE Vector squares(const std::complex<double>* z) {
  Vector re, im;
  hn::LoadInterleaved2(Doubles(), reinterpret_cast<const double*>(z), re, im);
  return hn::MulAdd(re, re, hn::Mul(im, im));
}

template <typename Complex>
HWY_ATTR void add_span(const float* weight, const Complex* visibility, std::size_t count, SampleSums& sums) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  Vector weights = hn::Zero(d), magnitudes = hn::Zero(d), powers = hn::Zero(d), weighted_powers = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Vector w = hn::PromoteTo(d, hn::LoadU(Floats(), weight + i));
    const Vector square = hn::IfThenElseZero(hn::Ne(w, hn::Zero(d)), squares(visibility + i));  // may be NaN at weight 0
    const Vector power = hn::Mul(w, square);
    weights = hn::Add(weights, w);
    magnitudes = hn::MulAdd(w, hn::Sqrt(square), magnitudes);
    powers = hn::Add(powers, power);
    weighted_powers = hn::MulAdd(w, power, weighted_powers);
  }
  sums.weight += hn::GetLane(hn::SumOfLanes(d, weights));
  sums.weight_abs += hn::GetLane(hn::SumOfLanes(d, magnitudes));
  sums.weight_square += hn::GetLane(hn::SumOfLanes(d, powers));
  sums.weight2_square += hn::GetLane(hn::SumOfLanes(d, weighted_powers));
  for (; i < count; ++i)
    if (weight[i] != 0) add_to_sums(sums, double{weight[i]}, std::complex<double>(visibility[i]));
}

HWY_ATTR void add_single_span(const float* weight, const std::complex<float>* visibility, std::size_t count, SampleSums& sums) {
  add_span(weight, visibility, count, sums);
}
HWY_ATTR void add_double_span(const float* weight, const std::complex<double>* visibility, std::size_t count,
                              SampleSums& sums) {
  add_span(weight, visibility, count, sums);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(add_single_span);
HWY_EXPORT(add_double_span);

void add_span_to_sums(const float* weight, const std::complex<float>* visibility, std::size_t count, SampleSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_single_span)(weight, visibility, count, sums);
}
void add_span_to_sums(const float* weight, const std::complex<double>* visibility, std::size_t count, SampleSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_double_span)(weight, visibility, count, sums);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
