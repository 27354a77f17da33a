#include "imager/hogbom_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/hogbom_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The larger of peak and |value|; peak where value is NaN: given one, hn::Max takes the second argument on x86 and the number
/// on Arm.
template <typename V>
HWY_ATTR V larger(V peak, V value) {
  return hn::Max(hn::Abs(value), peak);
}

HWY_ATTR float subtract_and_peak_row(float* residual, const float* psf, int count, float factor) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto f = hn::Set(d, factor);
  auto peak = hn::Zero(d);
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto left = hn::NegMulAdd(f, hn::LoadU(d, psf + i), hn::LoadU(d, residual + i));
    hn::StoreU(left, d, residual + i);
    peak = larger(peak, left);
  }
  float largest = hn::GetLane(hn::MaxOfLanes(d, peak));
  for (; i < count; ++i) {
    residual[i] = std::fma(-factor, psf[i], residual[i]);
    largest = std::max(largest, std::abs(residual[i]));
  }
  return largest;
}

HWY_ATTR float peak_of_row(const float* value, int count) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto peak = hn::Zero(d);
  int i = 0;
  for (; i + lanes <= count; i += lanes) peak = larger(peak, hn::LoadU(d, value + i));
  float largest = hn::GetLane(hn::MaxOfLanes(d, peak));
  for (; i < count; ++i) largest = std::max(largest, std::abs(value[i]));
  return largest;
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(subtract_and_peak_row);
HWY_EXPORT(peak_of_row);

float subtract_and_peak(float* residual, const float* psf, int count, float factor) {
  return HWY_DYNAMIC_DISPATCH(subtract_and_peak_row)(residual, psf, count, factor);
}

float peak_magnitude(const float* value, int count) {
  return HWY_DYNAMIC_DISPATCH(peak_of_row)(value, count);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
